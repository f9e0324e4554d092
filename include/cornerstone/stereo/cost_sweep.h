// The disparity search. The cost of a disparity at a pixel is the feature differences of all camera pairs,
// summed over a window; a disparity image is then sought whose costs are low and which changes seldom (semi-
// global matching, Hirschmueller, 2008), along paths from the left, the right and above:
//
//   E = sum C(x, d(x)) + P1 [neighbour differs by 1] + P2(brightness step) [neighbour differs by more]
//
// A depth step costs less where the brightness changes too. Where one camera does not see a pixel the other's
// cost counts double, so that windows across its border stay fair; where none does, the cost at disparity 0
// is assumed.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/workers.h"
#include "cornerstone/stereo/box_sums.h"
#include "cornerstone/stereo/secondary_view.h"

namespace cornerstone {

struct SweepInput {
  const cv::Mat1b* reference_image = nullptr;
  const GradientFeatures* reference = nullptr;
  std::array<SecondaryView, 2> views;
  std::size_t view_count = 0;
  int max_disparity_px = 0;
  int window_px = 7;  // edge, odd, 3..7
};

// One value a pixel.
struct Winners {
  static constexpr short kNoCost = 32767;
  cv::Mat1s disparity_px;  // of the lowest sum over all paths
  cv::Mat1s cost;          // over the window: see windowCost(); kNoCost: no camera sees the pixel
  cv::Mat1s cost_before;   // at disparity - 1
  cv::Mat1s cost_after;    // at disparity + 1
  cv::Mat1s chance_cost;   // of disparities just outside the search: what unrelated pixels cost here
  cv::Mat1b own_cost;      // of the pixel alone
  cv::Mat1b margin, lead;  // see PathWinners
};

// The columns that one worker sweeps, and what it keeps of them from row to row.
struct SweepStripe {
  cv::Range columns;
  cv::Range window_columns;  // those and what their windows reach
  int rows_known = 0;        // pair costs are known above this row
  cv::Mat1b pair_costs;      // a ring of rows
  cv::Mat_<std::uint16_t> column_sums;
  std::vector<int> entering, leaving;  // columns of the sliding window, mirrored, of window_columns
  cv::Mat1b path_sums;                 // of one pixel
  std::array<SecondaryView::Gathered, 2> gathered;
};

// Rows are swept in rounds. In each, every worker takes the window costs of its stripe of columns, then the
// paths along some of the rows, then, in its stripe again, the path from above: what a row and what a column
// needs are never worked on at the same time, so that the answer does not depend on the number of workers.
class CostSweep {
 public:
  // Disparities are searched up to max_disparity_px rounded up to a number that suits the processor.
  static int disparitiesFor(int max_disparity_px);
  const Winners& run(const SweepInput& input, Workers& workers);

 private:
  void prepare(const SweepInput& input, int workers);
  void prepareRows(int workers);
  void prepareStripe(SweepStripe& stripe, const cv::Range& columns);
  void planeCosts(int row, int disparity_px, std::uint8_t* costs);
  void endCosts(Workers& workers);
  std::uint8_t* pairCostsOf(SweepStripe& stripe, int row);
  void knowPairCosts(SweepStripe& stripe, int end_row);
  void pairCosts(SweepStripe& stripe, int row, const cv::Range& columns);
  void columnSums(SweepStripe& stripe, int row);
  void windowCosts(SweepStripe& stripe, int row);
  void jumpPenalties(const SweepStripe& stripe, int row);
  PathRow pathsOf(int row, int first_column);
  void pathDown(SweepStripe& stripe, int row);
  void keep(SweepStripe& stripe, int row);

  const SweepInput* input_ = nullptr;
  const SweepKernels* kernels_ = nullptr;
  cv::Size size_px_;
  int disparities_ = 0, round_rows_ = 1;
  std::vector<SweepStripe> stripes_;
  cv::Mat1b zeros_;
  // Of the rows of a round:
  cv::Mat_<std::uint16_t> sums_;
  cv::Mat1b costs_, from_left_, from_right_, jump_ahead_, jump_down_;
  cv::Mat1b from_above_, lowest_above_;
  cv::Mat1s nearest_, farthest_;  // window costs of the disparities just outside the search
  cv::Mat1b plane_;               // pair costs at one disparity
  std::array<cv::Mat1b, 2> camera_planes_;
  cv::Mat1b unseen_costs_;
  BoxSums box_sums_;
  Winners winners_;
};

}  // namespace cornerstone
