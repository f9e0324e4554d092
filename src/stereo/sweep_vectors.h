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

// Calls work(Vectors<k>()), k being how many vectors the costs of a pixel fill; 0: more than 3.
template <int k>
struct Vectors {
  static constexpr int kCount = k;
};
template <typename Work>
void withVectorsOf(int disparities, const Work& work) {
  switch (disparities / kLanes) {
    case 1:
      return work(Vectors<1>());
    case 2:
      return work(Vectors<2>());
    case 3:
      return work(Vectors<3>());
    default:
      return work(Vectors<0>());
  }
}

inline Bytes countingUp() {
  std::uint8_t steps[kLanes];
  for (int i = 0; i < kLanes; ++i) steps[i] = static_cast<std::uint8_t>(i);
  return cv::vx_load(steps);
}

// The lower half against the upper one, until a vector of 16 is left; and back to whole vectors. What goes by
// way of a scalar, as OpenCV's v_reduce_min and vx_setall, is slow where the next pixel waits for it.
#if CV_AVX2
inline cv::v_uint8x16 lowerOfHalves(const Bytes& values) {
  return cv::v_uint8x16(
      _mm_min_epu8(_mm256_castsi256_si128(values.val), _mm256_extracti128_si256(values.val, 1)));
}
inline Bytes firstEverywhere(const cv::v_uint8x16& values) {
  return Bytes(_mm256_broadcastb_epi8(values.val));
}
#else
static_assert(kLanes == cv::v_uint8x16::nlanes, "no wider vectors but those of AVX2 are known");
inline cv::v_uint8x16 lowerOfHalves(const Bytes& values) { return values; }
inline Bytes firstEverywhere(const cv::v_uint8x16& values) { return bytesOf(values.get0()); }
#endif

// The first two lanes get the lowest of those at even and at odd places.
inline cv::v_uint8x16 lowestOfPairs(const Bytes& values) {
  cv::v_uint8x16 lowest = lowerOfHalves(values);
  lowest = cv::v_min(lowest, cv::v_rotate_right<8>(lowest));
  lowest = cv::v_min(lowest, cv::v_rotate_right<4>(lowest));
  return cv::v_min(lowest, cv::v_rotate_right<2>(lowest));
}

inline Bytes lowestEverywhere(const Bytes& values) {
  const cv::v_uint8x16 lowest = lowestOfPairs(values);
  return firstEverywhere(cv::v_min(lowest, cv::v_rotate_right<1>(lowest)));
}

}  // namespace
}  // namespace cornerstone
