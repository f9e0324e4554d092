#include "cornerstone/stereo/validation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "cornerstone/stereo/cost_noise.h"

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

namespace {

// Where a secondary camera sees reference pixels, as an index into its image.
class Projection {
 public:
  Projection(const SecondaryView& view, cv::Size size, std::vector<cv::Point>& offsets)
      : size_(size), offsets_(offsets) {
    offsets_.clear();
    for (int d = 0; d <= view.disparities(); ++d) offsets_.push_back(view.offsetAt(d));
  }
  int of(int x, int y, int disparity_px) const {  // -1: not in the image
    const cv::Point offset = offsets_[static_cast<std::size_t>(disparity_px)];
    const int sx = x + offset.x, sy = y + offset.y;
    const bool inside = static_cast<unsigned>(sx) < static_cast<unsigned>(size_.width) &&
                        static_cast<unsigned>(sy) < static_cast<unsigned>(size_.height);
    return inside ? sy * size_.width + sx : -1;
  }

 private:
  cv::Size size_;
  std::vector<cv::Point>& offsets_;
};

}  // namespace

void Validator::checkSecondary(const Winners& winners, const SecondaryView& view, int tolerance_px,
                               cv::Mat1b& rejection) {
  const Projection seen_at(view, rejection.size(), offsets_);
  constexpr int kCostUnit = 1 << 16;  // a claim is its cost, and below it its disparity
  claims_.create(rejection.size());
  claims_.setTo(std::numeric_limits<int>::max());
  int* claims = claims_[0];
  for (int y = 0; y < rejection.rows; ++y) {
    const short *costs = winners.cost[y], *disparities_px = winners.disparity_px[y];
    for (int x = 0; x < rejection.cols; ++x) {
      const int seen = seen_at.of(x, y, disparities_px[x]);
      if (seen >= 0) claims[seen] = std::min(claims[seen], costs[x] * kCostUnit + disparities_px[x]);
    }
  }
  for (int y = 0; y < rejection.rows; ++y) {
    const short* disparities_px = winners.disparity_px[y];
    std::uint8_t* rejections = rejection[y];
    for (int x = 0; x < rejection.cols; ++x) {
      if (rejections[x] != codeOf(Rejection::kNone)) continue;
      const int seen = seen_at.of(x, y, disparities_px[x]);
      if (seen >= 0 && std::abs(claims[seen] % kCostUnit - disparities_px[x]) > tolerance_px)
        rejections[x] = codeOf(Rejection::kLeftRight);
    }
  }
}

void Validator::checkOwnCosts(const Winners& winners, const SweepInput& input, double largest_share,
                              cv::Mat1b& rejection) {
  cv::blur(winners.own_cost, own_costs_, {input.window_px, input.window_px}, {-1, -1}, cv::BORDER_REFLECT);
  rejection.setTo(codeOf(Rejection::kTexture), (own_costs_ > largest_share * kChanceCost) & (rejection == 0));
}

}  // namespace cornerstone
