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

// The lowest lane, as a number or in every lane. Paths wait for it at each pixel: OpenCV's v_reduce_min takes
// twice as long, and the way to all lanes by way of a number as long again.
#if CV_AVX2
inline __m128i lowestFirst(const Bytes& values) {
  const __m128i half =
      _mm_min_epu8(_mm256_castsi256_si128(values.val), _mm256_extracti128_si256(values.val, 1));
  return _mm_minpos_epu16(_mm_min_epu8(half, _mm_srli_epi16(half, 8)));
}
inline int lowestOf(const Bytes& values) { return _mm_cvtsi128_si32(lowestFirst(values)) & 255; }
inline Bytes lowestEverywhere(const Bytes& values) {
  return Bytes(_mm256_broadcastb_epi8(lowestFirst(values)));
}
#else
inline int lowestOf(const Bytes& values) { return cv::v_reduce_min(values); }
inline Bytes lowestEverywhere(const Bytes& values) { return bytesOf(lowestOf(values)); }
#endif

}  // namespace
}  // namespace cornerstone
