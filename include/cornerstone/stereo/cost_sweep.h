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
  cv::Mat1b margin, lead;  // see PathWinner
};

class CostSweep {
 public:
  // Disparities are searched up to max_disparity_px rounded up to a number that suits the processor.
  static int disparitiesFor(int max_disparity_px);
  const Winners& run(SweepInput& input);

 private:
  void prepare(SweepInput& input);
  void planeCosts(int disparity_px);
  void endCosts();
  std::uint8_t* pairCostsOf(int row);
  void windowSums(int row);
  void jumpPenalties(int row);
  void keep(int row);

  SweepInput* input_ = nullptr;
  const SweepKernels* kernels_ = nullptr;
  cv::Size size_px_;
  int disparities_ = 0, rows_known_ = 0;
  std::vector<int> entering_, leaving_;  // columns of the sliding window, mirrored
  cv::Mat1b pair_costs_;                 // a ring of rows, as many as a window and one
  cv::Mat1b zeros_;
  cv::Mat_<std::uint16_t> column_sums_, sums_;
  cv::Mat1b costs_, from_left_, from_right_, from_above_, lowest_above_, path_sums_;
  std::vector<std::uint8_t> jump_ahead_, jump_down_;
  std::vector<PathWinner> path_winners_;
  cv::Mat1s nearest_, farthest_;  // window costs of the disparities just outside the search
  cv::Mat1b plane_;               // pair costs at one disparity
  std::array<cv::Mat1b, 2> camera_planes_;
  cv::Mat1b unseen_costs_;
  BoxSums box_sums_;
  Winners winners_;
};

}  // namespace cornerstone
