// Sums over a square window around each pixel; beyond the border the image is mirrored (its first row comes
// twice). As cv::boxFilter, but without buffers of its own in every frame.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace cornerstone {

// Index within 0 .. count - 1 of a mirrored one: -1 -> 0, count -> count - 1.
int mirrored(int at, int count);

class BoxSums {
 public:
  // `window_px` is odd; sums fit 16 bits up to 11 px.
  void compute(const cv::Mat1b& image, int window_px, cv::Mat1s& sums);

 private:
  std::vector<std::uint16_t> columns_;  // sums over the window's rows, with the window's radius on both sides
};

}  // namespace cornerstone
