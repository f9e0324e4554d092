// What noise makes of a window cost of CostSweep: the standard deviation of the difference of two costs
// beside the winner. Absolute differences scatter by about their mean, n of them by its root; neighbouring
// features share pixels. The factors were measured on synthetic surfaces (test/stereo/subpixel_test.cpp).
#pragma once

#include <cmath>
#include <cstddef>

namespace cornerstone {

class CostNoise {
 public:
  CostNoise(int window_px, std::size_t cameras)
      : factor_(kFactor / static_cast<float>(window_px) * std::sqrt(2.F / static_cast<float>(cameras))) {}
  float sigmaAt(float cost) const { return factor_ * (cost + kLeastCost); }
  float share() const { return factor_; }  // of the cost, without what rounding adds

 private:
  static constexpr float kFactor = 0.85F;
  static constexpr float kLeastCost = 16;  // images are rounded to grey levels
  float factor_;
};

}  // namespace cornerstone
