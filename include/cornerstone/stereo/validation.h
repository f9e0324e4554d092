// Which winners of the sweep can be believed, and why not the others.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/box_sums.h"
#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/edge_check.h"

namespace cornerstone {

struct ValidationParams {
  double smallest_margin_share = 0.5;  // between best and second-best path sums, of kChanceCost
  // Margin (as above) times Winners::lead in the cost's noise (CostNoise).
  double strong_product = 3;
  double smallest_edge_cost_ratio = 1.4;  // see EdgeCheck
  double largest_own_share = 0.8;         // of kChanceCost: mean cost of the window's pixels at their winners
  int left_right_tolerance_px = 1;  // whole pixels between the answers of two reference pixels seen as one
};

struct ValidationInput {
  const Winners& winners;
  const SweepInput& sweep;
};

// What a pixel's costs say of its answer: beyond doubt, or not, or that there is nothing to correlate.
enum class Evidence : std::uint8_t { kWeak = 0, kStrong = 1, kFlat = 2 };

class Validator {
 public:
  // Sets `rejection` to kNone, kOutside, kTexture, kUniqueness, kLeftRight, kRange or kPairs for every pixel
  // of the image.
  void check(const ValidationInput& input, const ValidationParams& params, Workers& workers,
             cv::Mat1b& rejection);

  // Evidence of each pixel in the last check.
  const cv::Mat1b& evidence() const { return evidence_; }

 private:
  void checkWinners(const ValidationInput& input, const ValidationParams& params, const cv::Range& rows,
                    cv::Mat1b& rejection);
  void countSteps(const SecondaryView& view, int width);
  // Two reference pixels that a secondary camera would see at one place: only the better matching one can be
  // right. The second view comes after the first: where both see a pixel, it tells kLeftRight from kPairs.
  // Within an area that holds whole lines along the view's shift.
  void checkSecondary(const ValidationInput& input, std::size_t view, const cv::Rect& area,
                      cv::Mat1b& rejection);

  // A pixel beside a textured surface takes its disparity from the wide windows though nothing matches around
  // it.
  void checkOwnCosts(const ValidationInput& input, double largest_share, Workers& workers,
                     cv::Mat1b& rejection);

  EdgeCheck edge_check_;
  BoxSums box_sums_;
  cv::Mat1s own_costs_;
  cv::Mat1b evidence_;
  cv::Mat1i claims_;  // by secondary pixel
  std::vector<int> steps_;
  int tolerance_px_ = 0;
};

}  // namespace cornerstone
