// Plane sweep: for every candidate disparity the census costs of all camera pairs are summed, then summed
// over three windows around the pixel of which each pixel of the image counts for less the farther it is, and
// each pixel keeps its best and second-best local minimum. With S the sum over the fine window (w x w px):
//
//   cost(x, y, d) = (32 S(x, y) + 2 sum S(x + i w, y + j w; -1..1) + sum S(x + i w, y + j w; -2..2)) / 2
//
// so that the windows of w, 3 w and 5 w count about alike. The fine one keeps depth edges in place, the wide
// ones decide where there is little texture or much noise. Where one camera does not see a pixel the other's
// cost counts double, so that windows across its border stay fair; where none does, chance is assumed.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/census.h"

namespace cornerstone {

// A secondary camera: its census image and where it sees a reference pixel.
class SecondaryView {
 public:
  SecondaryView(const cv::Mat1b& census, const cv::Point2d& shift);  // shift as in TrinocularRig
  const cv::Mat1b& census() const { return *census_; }
  // Seen pixel less reference pixel, rounded to whole pixels.
  cv::Point offsetAt(int disparity_px) const {
    return {(shift_fixed_.x * disparity_px + kHalf) >> kFractionBits,
            (shift_fixed_.y * disparity_px + kHalf) >> kFractionBits};
  }

 private:
  static constexpr int kFractionBits = 16, kHalf = 1 << (kFractionBits - 1);
  const cv::Mat1b* census_;
  cv::Point shift_fixed_;
};

struct SweepInput {
  const cv::Mat1b* reference_census = nullptr;
  std::vector<SecondaryView> views;  // one or two
  int max_disparity_px = 0;          // disparities 0 .. max + 1 are swept; the two ends are only neighbours
  int window_px = 7;                 // edge of the fine window: odd, 3..7
};

// One value a pixel; costs are below kNoCost.
struct Winners {
  static constexpr short kNoCost = 32767;
  cv::Mat1s disparity_px;  // of the lowest local minimum; 0 or max + 1: at the range's end
  cv::Mat1s cost;          // kNoCost: no camera sees the pixel
  cv::Mat1s cost_before;   // at disparity - 1
  cv::Mat1s cost_after;    // at disparity + 1
  cv::Mat1s second_cost;   // of the next best local minimum; kNoCost: there is none
};

class CostSweep {
 public:
  static constexpr int kFineWeight = 32, kInnerWeight = 2, kDivisor = 2;  // of the sum above
  static constexpr int kWeightSum = kFineWeight + 9 * kInnerWeight + 25;
  const Winners& run(const SweepInput& input);

 private:
  struct Band {
    int first_row = 0, end_row = 0;  // rows to answer
    int first_sum = 0, end_sum = 0;  // rows of fine sums needed
    int first_pair = 0, end_pair = 0;
  };
  void prepare(const SweepInput& input);
  Band bandFrom(int first_row) const;
  void sweepBand(const Band& band);
  void pairCosts(const Band& band, int disparity_px);
  void fineSums(const Band& band);
  void sumColumns(int row);
  void windowCosts(const Band& band, int disparity_px);
  void keepBest(const Band& band, int disparity_px);
  void maskUnseen(short* costs, int row, int disparity_px) const;

  SweepInput input_;
  cv::Size size_px_;
  int radius_px_ = 0;
  cv::Mat1b pair_costs_;                   // of a row, summed over cameras, with borders mirrored
  cv::Mat1b row_sums_;                     // of pair costs along the fine window
  cv::Mat_<std::uint16_t> fine_sums_;      // over the fine window, with borders mirrored
  cv::Mat_<std::uint16_t> inner_, outer_;  // of a row, see sumColumns
  std::array<cv::Mat1s, 3> costs_;         // of the disparities d, d - 1, d - 2
  Winners winners_;
};

}  // namespace cornerstone
