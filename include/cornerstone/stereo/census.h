// Census of a grey image: one byte a pixel that tells which of eight opposite pairs of neighbours rises. Gain
// and offset of a camera leave it as it is (Zabih and Woodfill, 1994; opposite pairs: Spangenberg et al.,
// 2013, which keeps the noise of the middle pixel out). The matching cost of two pixels is the number of bits
// that differ.
#pragma once

#include <opencv2/core.hpp>

namespace cornerstone {

constexpr int kCensusBits = 8;

// Holds the padded copy of the image, so that nothing is allocated frame by frame.
class CensusTransform {
 public:
  void apply(const cv::Mat1b& image, cv::Mat1b& census);

 private:
  cv::Mat1b padded_;
};

}  // namespace cornerstone
