#include "cornerstone/stereo/validation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cornerstone/stereo/cost_noise.h"
#include "cornerstone/stereo/fill.h"

namespace cornerstone {
namespace {

// What chance makes of the best of all disparities on a bare wall, in CostNoise: there is nothing to
// correlate.
constexpr float kFlatGain_sigmas = 3;
// Of a pixel whose match differs by rounding only, of kChanceCost.
constexpr int kLeastPairCost = 5;

constexpr std::uint8_t codeOf(Rejection rejection) { return static_cast<std::uint8_t>(rejection); }

}  // namespace

void Validator::check(const Winners& winners, const SweepInput& input, const ValidationParams& params,
                      cv::Mat1b& rejection) {
  rejection.create(input.reference->size());
  checkWinners(winners, input, params, rejection);
  for (std::size_t v = 0; v < input.view_count; ++v)
    checkSecondary(winners, input.views[v], params.left_right_tolerance_px, rejection);
  checkOwnCosts(winners, input, params.largest_own_share, rejection);
  edge_check_.check(winners, input, params.smallest_edge_cost_ratio, rejection);
}

void Validator::checkWinners(const Winners& winners, const SweepInput& input, const ValidationParams& params,
                             cv::Mat1b& rejection) {
  const int smallest_margin = static_cast<int>(std::lround(params.smallest_margin_share * kSearchChance));
  const int last_px = input.max_disparity_px;
  const CostNoise noise(input.window_px, input.view_count);
  const float flat_gain = kFlatGain_sigmas * noise.share();
  // Of chance matches both margin and lead are small: their product tells best what is beyond doubt.
  const int window_area = input.window_px * input.window_px;
  const double unit = static_cast<double>(kSearchChance) * kSearchChance / (window_area * kChanceCost);
  const auto strong_product = static_cast<float>(params.strong_product * unit) * noise.share();
  const int least_cost = kLeastPairCost * window_area;
  evidence_.create(rejection.size());
  for (int y = 0; y < rejection.rows; ++y) {
    const short *costs = winners.cost[y], *before = winners.cost_before[y], *after = winners.cost_after[y];
    const short* disparities_px = winners.disparity_px[y];
    const short* chance = winners.chance_cost[y];
    const std::uint8_t *margins = winners.margin[y], *leads = winners.lead[y];
    std::uint8_t *rejections = rejection[y], *evidence = evidence_[y];
    for (int x = 0; x < rejection.cols; ++x) {
      const int disparity_px = disparities_px[x];
      const bool outward = (disparity_px <= 1 && before[x] < costs[x]) ||
                           (disparity_px >= last_px && after[x] < costs[x]) || disparity_px > last_px;
      Rejection verdict = outward ? Rejection::kRange : Rejection::kNone;
      const int gain = std::max(chance[x] - costs[x], 0);
      const bool flat = static_cast<float>(gain) <= flat_gain * static_cast<float>(chance[x]);
      if (margins[x] < smallest_margin) verdict = flat ? Rejection::kTexture : Rejection::kUniqueness;
      if (costs[x] == Winners::kNoCost) verdict = Rejection::kOutside;
      rejections[x] = codeOf(verdict);
      const bool strong = static_cast<float>(margins[x] * leads[x]) >
                          strong_product * static_cast<float>(costs[x] + least_cost);
      evidence[x] = static_cast<std::uint8_t>(strong ? Evidence::kStrong
                                              : flat ? Evidence::kFlat
                                                     : Evidence::kWeak);
    }
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

void Validator::checkSecondary(const Winners& winners, const SecondaryView& view, int tolerance_px,
                               cv::Mat1b& rejection) {
  const int width = rejection.cols;
  countSteps(view, width);
  const int* steps = steps_.data();
  claims_.create(rejection.size());
  fillAll(claims_, std::numeric_limits<int>::max());
  for (int y = 0; y < rejection.rows; ++y) {
    const short *costs = winners.cost[y], *disparities_px = winners.disparity_px[y], *seen = view.seenOf(y);
    int* claims = claims_[y];
    for (int x = 0; x < width; ++x) {
      if (disparities_px[x] > seen[x]) continue;
      int& claim = claims[x + steps[disparities_px[x]]];
      claim = std::min(claim, costs[x] * kCostUnit + disparities_px[x]);
    }
  }
  for (int y = 0; y < rejection.rows; ++y) {
    const short *disparities_px = winners.disparity_px[y], *seen = view.seenOf(y);
    const int* claims = claims_[y];
    std::uint8_t* rejections = rejection[y];
    for (int x = 0; x < width; ++x) {
      if (rejections[x] != 0 || disparities_px[x] > seen[x]) continue;
      const int claimed_px = claims[x + steps[disparities_px[x]]] & (kCostUnit - 1);
      if (std::abs(claimed_px - disparities_px[x]) > tolerance_px)
        rejections[x] = codeOf(Rejection::kLeftRight);
    }
  }
}

void Validator::checkOwnCosts(const Winners& winners, const SweepInput& input, double largest_share,
                              cv::Mat1b& rejection) {
  box_sums_.compute(winners.own_cost, input.window_px, own_costs_);
  const double largest = largest_share * kChanceCost * input.window_px * input.window_px;
  for (int y = 0; y < rejection.rows; ++y) {
    const short* costs = own_costs_[y];
    std::uint8_t* rejections = rejection[y];
    for (int x = 0; x < rejection.cols; ++x)
      if (costs[x] > largest && rejections[x] == 0) rejections[x] = codeOf(Rejection::kTexture);
  }
}

}  // namespace cornerstone
