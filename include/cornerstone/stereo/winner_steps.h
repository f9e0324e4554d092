// Depth steps between neighbouring winners, found for whole rows at once: what looks closer at a pixel beside
// a step does so for few pixels.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace cornerstone {

class WinnerSteps {
 public:
  // Marks the pixels of row `y` whose disparity differs by more than a pixel from that of the pixel
  // `apart_px` to the right, to the left, below or above; beyond the border is no step.
  const std::uint8_t* of(const cv::Mat1s& disparity_px, int y, int apart_px);

 private:
  std::vector<std::uint8_t> marks_;
};

}  // namespace cornerstone
