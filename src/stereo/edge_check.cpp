#include "cornerstone/stereo/edge_check.h"

#include <algorithm>
#include <cstdlib>

#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/marks.h"
#include "cornerstone/stereo/pixel_cost.h"
#include "cornerstone/stereo/validation.h"

namespace cornerstone {
namespace {

constexpr int kStep_px = 1;  // neighbours on one surface differ by no more
// Of pixels that are beyond doubt: any better. Half: hardly a change on photographs; nearly double: a
// fiftieth more missed columns, thin things.
constexpr double kStrongCostRatio = 1;

}  // namespace

bool EdgeCheck::standsOut(const Winners& winners, const SweepInput& input, cv::Point at,
                          double smallest_cost_ratio) const {
  const int reach_px = input.window_px / 2 + 1, own_px = winners.disparity_px(at);
  double own_cost = -1;
  bool beside_none = false;
  for (const cv::Point step : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
    const cv::Point other = at + step * reach_px;
    if (other.x < 0 || other.y < 0 || other.x >= before_.cols || other.y >= before_.rows) continue;
    const int other_px = winners.disparity_px(other);
    if (std::abs(other_px - own_px) <= kStep_px) continue;
    if (own_cost < 0) own_cost = costAround(input, at, own_px);
    beside_none = beside_none || before_(other) != 0;
    if (before_(other) == 0 && costAround(input, at, other_px) < smallest_cost_ratio * own_cost) return false;
  }
  if (!beside_none) return true;
  return costsMoreAside(input, at, own_px, smallest_cost_ratio * own_cost + kNoiseCostAround);
}

void EdgeCheck::check(const Winners& winners, const SweepInput& input, const How& how, cv::Mat1b& rejection) {
  rejection.copyTo(before_);
  const int reach_px = input.window_px / 2 + 1;
  steps_.resize(static_cast<std::size_t>(how.workers.count()));
  how.workers.share(rejection.rows, [&](int begin, int end, int worker) {
    WinnerSteps& steps = steps_[static_cast<std::size_t>(worker)];
    for (int y = begin; y < end; ++y) {
      const std::uint8_t *beside_edge = steps.of(winners.disparity_px, y, reach_px), *before = before_[y];
      forEachMarked(beside_edge, rejection.cols, [&](int x) {
        if (before[x] != 0) return;
        const bool strong = how.evidence(y, x) == static_cast<std::uint8_t>(Evidence::kStrong);
        if (!standsOut(winners, input, {x, y}, strong ? kStrongCostRatio : how.smallest_cost_ratio))
          rejection(y, x) = static_cast<std::uint8_t>(Rejection::kUniqueness);
      });
    }
  });
}

}  // namespace cornerstone
