// What noise makes of a window cost of CostSweep: the standard deviation of the difference of two costs
// beside the winner. Absolute differences scatter by about their mean, n of them by its root; neighbouring
// features share pixels. The factors were measured on synthetic surfaces (test/stereo/subpixel_test.cpp).
#pragma once

#include <cmath>
#include <cstddef>

namespace cornerstone {

class CostNoise {
 public:
  static constexpr float kLeastCost = 16;  // images are rounded to grey levels
  CostNoise(int window_px, std::size_t cameras)
      : factor_(kFactor / static_cast<float>(window_px) * std::sqrt(2.F / static_cast<float>(cameras))) {}
  // Of the cost and kLeastCost together.
  float share() const { return factor_; }

 private:
  static constexpr float kFactor = 0.85F;
  float factor_;
};

}  // namespace cornerstone
