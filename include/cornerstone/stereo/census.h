// Census of a grey image: one byte a pixel that tells which of eight opposite pairs of neighbours rises. Gain
// and offset of a camera leave it as it is (Zabih and Woodfill, 1994; opposite pairs: Spangenberg et al.,
// 2013, which keeps the noise of the middle pixel out). Bits 0 to 3: right, down, right-down and left-down at
// 1 px; bits 4 to 7: the same at 2 px in the image smoothed by 3 x 3, which see weak and smooth texture
// through noise. The matching cost of two pixels is the number of bits that differ.
#pragma once

#include <opencv2/core.hpp>

namespace cornerstone {

constexpr int kCensusBits = 8;

// Holds copies of the image, so that nothing is allocated frame by frame.
class CensusTransform {
 public:
  void apply(const cv::Mat1b& image, cv::Mat1b& census);

 private:
  cv::Mat1b smooth_, padded_, padded_smooth_;
};

}  // namespace cornerstone
