// What chance makes of a cost of CostSweep. It counts flipped census bits, so its standard deviation goes
// with its root, and with one camera each bit counts twice. The factor holds the window weights and what
// neighbouring bits share; it was measured on synthetic surfaces (test/stereo/subpixel_test.cpp) as the
// scatter of the equiangular fit.
#pragma once

#include <cmath>
#include <cstddef>

#include "cornerstone/stereo/cost_sweep.h"

namespace cornerstone {

class CostNoise {
 public:
  explicit CostNoise(std::size_t cameras) : factor_(4.4F * std::sqrt(2.F / static_cast<float>(cameras))) {}
  float sigmaAt(float cost) const { return factor_ * std::sqrt(cost + kLeastCost); }

 private:
  static constexpr float kLeastCost = 25.F;  // about one flipped bit: images are rounded to grey levels
  float factor_;
};

// The cost of two images that have nothing to do with each other: half of all bits.
constexpr float chanceCost(int window_px) {
  const int area = window_px * window_px;
  return static_cast<float>(CostSweep::kWeightSum * area * kCensusBits) / CostSweep::kDivisor;
}

}  // namespace cornerstone
