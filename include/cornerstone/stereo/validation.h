// Which winners of the sweep can be believed, and why not the others.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

struct ValidationParams {
  double largest_cost_ratio = 0.93;  // best to second-best cost; 1: any winner will do
  int left_right_tolerance_px = 1;   // whole pixels between the answers of two reference pixels seen as one
};

class Validator {
 public:
  // Sets `rejection` to kNone, kOutside, kUniqueness, kLeftRight or kRange for every pixel of the image.
  void check(const Winners& winners, const SweepInput& input, const ValidationParams& params,
             cv::Mat1b& rejection);

 private:
  // Two reference pixels that a secondary camera would see at one place: only the better matching one can be
  // right.
  void checkSecondary(const Winners& winners, const SecondaryView& view, int tolerance_px,
                      cv::Mat1b& rejection);

  cv::Mat1s claim_cost_, claim_disparity_px_;
};

}  // namespace cornerstone
