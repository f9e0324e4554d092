#include "cornerstone/stereo/validation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cornerstone/stereo/cost_noise.h"

namespace cornerstone {
namespace {

// What chance makes of the best of all disparities on a bare wall, in CostNoise: there is nothing to
// correlate.
constexpr float kFlatGain_sigmas = 3;
// Of a pixel whose match differs by rounding only, of kChanceCost.
constexpr int kLeastPairCost = 5;

// What secondary pixels are claimed by is looked at again while it is still in the cache.
constexpr int kLinesTogether = 16;

template <typename Code>
constexpr std::uint8_t codeOf(Code code) {
  return static_cast<std::uint8_t>(code);
}

}  // namespace

void Validator::check(const ValidationInput& input, const ValidationParams& params, Workers& workers,
                      cv::Mat1b& rejection) {
  const cv::Size size = input.sweep.reference->size();
  rejection.create(size);
  evidence_.create(size);
  claims_.create(size);
  tolerance_px_ = params.left_right_tolerance_px;
  workers.share(size.height, [&](int begin, int end) {
    checkWinners(input, params, {begin, end}, rejection);
  });
  for (std::size_t v = 0; v < input.sweep.view_count; ++v) {
    const SecondaryView& view = input.sweep.views[v];
    countSteps(view, size.width);
    workers.share(view.vertical() ? size.width : size.height, [&](int begin, int end) {
      for (int at = begin; at < end; at += kLinesTogether) {
        const int lines = std::min(kLinesTogether, end - at);
        checkSecondary(
            input, v,
            view.vertical() ? cv::Rect(at, 0, lines, size.height) : cv::Rect(0, at, size.width, lines),
            rejection);
      }
    });
  }
  checkOwnCosts(input, params.largest_own_share, workers, rejection);
  edge_check_.check(input.winners, input.sweep, {params.smallest_edge_cost_ratio, evidence_, workers},
                    rejection);
}

void Validator::checkWinners(const ValidationInput& input, const ValidationParams& params,
                             const cv::Range& rows, cv::Mat1b& rejection) {
  const Winners& winners = input.winners;
  const CostNoise noise(input.sweep.window_px, input.sweep.view_count);
  // Of chance matches both margin and lead are small: their product tells best what is beyond doubt.
  const int window_area = input.sweep.window_px * input.sweep.window_px;
  const double unit = static_cast<double>(kSearchChance) * kSearchChance / (window_area * kChanceCost);
  WinnerRow row;
  row.width = rejection.cols;
  row.last_px = input.sweep.max_disparity_px;
  row.smallest_margin = static_cast<int>(std::lround(params.smallest_margin_share * kSearchChance));
  row.least_cost = kLeastPairCost * window_area;
  row.no_cost = Winners::kNoCost;
  row.flat_gain = kFlatGain_sigmas * noise.share();
  row.strong_product = static_cast<float>(params.strong_product * unit) * noise.share();
  row.outside = codeOf(Rejection::kOutside);
  row.texture = codeOf(Rejection::kTexture);
  row.uniqueness = codeOf(Rejection::kUniqueness);
  row.range = codeOf(Rejection::kRange);
  row.weak = codeOf(Evidence::kWeak);
  row.flat = codeOf(Evidence::kFlat);
  row.strong = codeOf(Evidence::kStrong);
  for (int y = rows.start; y < rows.end; ++y) {
    row.disparities_px = winners.disparity_px[y];
    row.costs = winners.cost[y];
    row.before = winners.cost_before[y];
    row.after = winners.cost_after[y];
    row.chance = winners.chance_cost[y];
    row.margins = winners.margin[y];
    row.leads = winners.lead[y];
    sweepKernels().judge(row, rejection[y], evidence_[y]);
  }
}

// A claim is its cost, and below it its disparity.
constexpr int kCostUnit = 1 << 16;

// Steps from a reference pixel to where a secondary image, laid out in memory as the reference image, shows
// it at each disparity.
void Validator::countSteps(const SecondaryView& view, int width) {
  steps_.resize(static_cast<std::size_t>(view.disparities() + 1));
  for (int d = 0; d <= view.disparities(); ++d) {
    const cv::Point offset = view.offsetAt(d);
    steps_[static_cast<std::size_t>(d)] = offset.y * width + offset.x;
  }
}

void Validator::checkSecondary(const ValidationInput& input, std::size_t view_index, const cv::Rect& area,
                               cv::Mat1b& rejection) {
  const Winners& winners = input.winners;
  const SecondaryView& view = input.sweep.views[view_index];
  const int* steps = steps_.data();
  const int end_x = area.br().x, tolerance_px = tolerance_px_;
  for (int y = area.y; y < area.br().y; ++y)
    std::fill_n(claims_[y] + area.x, area.width, std::numeric_limits<int>::max());
  for (int y = area.y; y < area.br().y; ++y) {
    const short *costs = winners.cost[y], *disparities_px = winners.disparity_px[y], *seen = view.seenOf(y);
    int* claims = claims_[y];
    for (int x = area.x; x < end_x; ++x) {
      if (disparities_px[x] > seen[x]) continue;
      int& claim = claims[x + steps[disparities_px[x]]];
      claim = std::min(claim, costs[x] * kCostUnit + disparities_px[x]);
    }
  }
  for (int y = area.y; y < area.br().y; ++y) {
    const short *disparities_px = winners.disparity_px[y], *seen = view.seenOf(y);
    const short* seen_by_first = view_index > 0 ? input.sweep.views[0].seenOf(y) : nullptr;
    const int* claims = claims_[y];
    std::uint8_t* rejections = rejection[y];
    for (int x = area.x; x < end_x; ++x) {
      const int disparity_px = disparities_px[x];
      const bool by_first = rejections[x] == codeOf(Rejection::kLeftRight);
      if (rejections[x] != 0 && !by_first) continue;
      if (disparity_px > seen[x]) continue;
      const int claimed_px = claims[x + steps[disparity_px]] & (kCostUnit - 1);
      const bool contradicts = std::abs(claimed_px - disparity_px) > tolerance_px;
      if (!contradicts && !by_first) continue;
      const bool seen_by_both = seen_by_first != nullptr && disparity_px <= seen_by_first[x];
      rejections[x] =
          codeOf(seen_by_both && contradicts != by_first ? Rejection::kPairs : Rejection::kLeftRight);
    }
  }
}

void Validator::checkOwnCosts(const ValidationInput& input, double largest_share, Workers& workers,
                              cv::Mat1b& rejection) {
  const int window_px = input.sweep.window_px;
  box_sums_.compute(input.winners.own_cost, window_px, own_costs_);
  const int largest = static_cast<int>(largest_share * kChanceCost * window_px * window_px);
  workers.share(rejection.rows, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const short* costs = own_costs_[y];
      std::uint8_t* rejections = rejection[y];
      for (int x = 0; x < rejection.cols; ++x)
        if (costs[x] > largest && rejections[x] == 0) rejections[x] = codeOf(Rejection::kTexture);
    }
  });
}

}  // namespace cornerstone
