// The vectors that the kernels work in, of the width that the including file is compiled for.
#pragma once

#include <opencv2/core/hal/intrin.hpp>

#include "cornerstone/stereo/sweep_kernels.h"

namespace cornerstone {
namespace {

using Bytes = cv::v_uint8;
using Words = cv::v_uint16;
constexpr int kLanes = Bytes::nlanes;
constexpr int kHalf = Words::nlanes;

inline Bytes bytesOf(int value) { return cv::vx_setall_u8(static_cast<std::uint8_t>(value)); }

inline Bytes countingUp() {
  std::uint8_t steps[kLanes];
  for (int i = 0; i < kLanes; ++i) steps[i] = static_cast<std::uint8_t>(i);
  return cv::vx_load(steps);
}

}  // namespace
}  // namespace cornerstone
