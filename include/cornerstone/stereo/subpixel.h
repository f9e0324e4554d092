// Sub-pixel disparity and its standard deviation, around whole-pixel winners.
//
// Census costs fall linearly on both sides of the truth, so two lines of opposite slope through the costs
// before, at and after the winner cross at it (equiangular fit): with s the steeper step of the two,
//   d = D + (before - after) / (2 s),   sigma = CostNoise(cost) / (2 s)
// Then the answers around on the same
// surface (steps of at most a pixel) are averaged with weights 1 / sigma^2. In px of the reference pair.
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/stereo/cost_sweep.h"

namespace cornerstone {

struct SubpixelInput {
  const Winners* winners = nullptr;
  const cv::Mat1b* rejection = nullptr;  // only winners with kNone count
  std::size_t cameras = 2;               // secondary ones: 1 or 2
  int window_px = 7;                     // of the sweep
  Workers* workers = nullptr;
};

struct SubpixelParams {
  int support_px = 5;  // edge of the support of the average, odd; 1: no averaging
};

class SubpixelRefiner {
 public:
  // Fills both planes, with 0 where there is no answer.
  void refine(const SubpixelInput& input, const SubpixelParams& params, cv::Mat1f& disparity_px,
              cv::Mat1f& sigma_px);

 private:
  void prepare(cv::Size size);
  void fitEach(const SubpixelInput& input, const cv::Range& rows);
  void averageAlong(std::ptrdiff_t step, Workers& workers);

  int radius_px_ = 0;  // of the support, and the width of the planes' borders
  // With a border; disparity far below zero and weight 0 where there is none.
  cv::Mat1f disparity_px_, weight_, averaged_px_, averaged_weight_;
};

}  // namespace cornerstone
