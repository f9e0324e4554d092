// Plane sweep: for every candidate disparity the census costs of all camera pairs are summed, then summed
// over a fine window and the 3 x 3 of them around (a coarse one), and each pixel keeps its best and
// second-best local minimum.
//
//   cost(x, y, d) = 9 * fine(x, y, d) + sum of fine(x + i w, y + j w, d) for i, j in -1..1
//
// Where one camera does not see a pixel the other's cost counts double, so that windows across its border
// stay fair; where none does, chance is assumed.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace cornerstone {

struct SecondaryView {
  const cv::Mat1b* census = nullptr;
  cv::Point2d shift;  // as in TrinocularRig
};

struct SweepInput {
  const cv::Mat1b* reference_census = nullptr;
  std::vector<SecondaryView> views;  // one or two
  int max_disparity_px = 0;          // disparities 0 .. max + 1 are swept; the two ends are only neighbours
  int window_px = 7;                 // edge of the fine window: odd, 3..9
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
  void windowCosts(const Band& band, int disparity_px);
  void keepBest(const Band& band, int disparity_px);
  void maskUnseen(short* costs, int row, int disparity_px) const;

  SweepInput input_;
  cv::Size size_px_;
  int radius_px_ = 0;
  cv::Mat1b pair_costs_;  // per pixel, summed over cameras, with borders reflected
  cv::Mat_<std::uint16_t> column_sums_;
  cv::Mat_<std::uint16_t> fine_sums_;  // with borders reflected
  cv::Mat_<std::uint16_t> three_rows_;
  std::array<cv::Mat1s, 3> costs_;  // of the disparities d, d - 1, d - 2
  Winners winners_;
};

}  // namespace cornerstone
