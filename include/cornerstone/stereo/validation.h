// Which winners of the sweep can be believed, and why not the others.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/edge_check.h"

namespace cornerstone {

struct ValidationParams {
  double smallest_margin_sigmas = 1.5;  // between best and second-best cost, in CostNoise of the best
  double smallest_gain_sigmas =
      4;  // between best cost and that of unrelated images, in CostNoise of the latter
  double smallest_edge_cost_ratio = 1.5;  // see EdgeCheck
  int left_right_tolerance_px = 1;  // whole pixels between the answers of two reference pixels seen as one
};

class Validator {
 public:
  // Sets `rejection` to kNone, kOutside, kTexture, kUniqueness, kLeftRight or kRange for every pixel of the
  // image.
  void check(const Winners& winners, const SweepInput& input, const ValidationParams& params,
             cv::Mat1b& rejection);

 private:
  void checkWinners(const Winners& winners, const SweepInput& input, const ValidationParams& params,
                    cv::Mat1b& rejection);
  // Two reference pixels that a secondary camera would see at one place: only the better matching one can be
  // right.
  void checkSecondary(const Winners& winners, const SecondaryView& view, int tolerance_px,
                      cv::Mat1b& rejection);

  EdgeCheck edge_check_;
  cv::Mat1s claim_cost_, claim_disparity_px_;
};

}  // namespace cornerstone
