#include "cornerstone/stereo/validation.h"

#include <cstdlib>

#include "cornerstone/stereo/cost_noise.h"

namespace cornerstone {
namespace {

constexpr std::uint8_t codeOf(Rejection rejection) { return static_cast<std::uint8_t>(rejection); }

// What a pixel's own costs say, where so many cameras see it.
class WinnerTest {
 public:
  WinnerTest(const ValidationParams& params, const SweepInput& input, std::size_t cameras)
      : noise_(cameras),
        margin_sigmas_(static_cast<float>(params.smallest_margin_sigmas)),
        max_disparity_px_(input.max_disparity_px) {
    const float chance = chanceCost(input.window_px);
    largest_cost_ = chance - static_cast<float>(params.smallest_gain_sigmas) * noise_.sigmaAt(chance);
  }
  Rejection verdictOn(short cost, short second_cost, short disparity_px) const {
    if (cost == Winners::kNoCost) return Rejection::kOutside;
    if (cost > largest_cost_) return Rejection::kTexture;
    const auto margin = static_cast<float>(second_cost - cost);
    if (margin < margin_sigmas_ * noise_.sigmaAt(cost)) return Rejection::kUniqueness;
    if (disparity_px <= 0 || disparity_px > max_disparity_px_) return Rejection::kRange;
    return Rejection::kNone;
  }

 private:
  CostNoise noise_;
  float margin_sigmas_, largest_cost_ = 0;
  int max_disparity_px_;
};

}  // namespace

void Validator::check(const Winners& winners, const SweepInput& input, const ValidationParams& params,
                      cv::Mat1b& rejection) {
  rejection.create(input.reference_census->size());
  checkWinners(winners, input, params, rejection);
  for (const SecondaryView& view : input.views)
    checkSecondary(winners, view, params.left_right_tolerance_px, rejection);
  edge_check_.check(winners, input, params.smallest_edge_cost_ratio, rejection);
}

void Validator::checkWinners(const Winners& winners, const SweepInput& input, const ValidationParams& params,
                             cv::Mat1b& rejection) {
  const WinnerTest all_cameras(params, input, input.views.size()), one_camera(params, input, 1);
  const cv::Rect image({0, 0}, rejection.size());
  for (int y = 0; y < rejection.rows; ++y) {
    const short *costs = winners.cost[y], *seconds = winners.second_cost[y],
                *disparities = winners.disparity_px[y];
    std::uint8_t* rejections = rejection[y];
    for (int x = 0; x < rejection.cols; ++x) {
      bool all_see = true;
      for (const SecondaryView& view : input.views)
        all_see = all_see && image.contains(cv::Point(x, y) + view.offsetAt(disparities[x]));
      const WinnerTest& test = all_see ? all_cameras : one_camera;
      rejections[x] = codeOf(test.verdictOn(costs[x], seconds[x], disparities[x]));
    }
  }
}

void Validator::checkSecondary(const Winners& winners, const SecondaryView& view, int tolerance_px,
                               cv::Mat1b& rejection) {
  const cv::Rect image({0, 0}, rejection.size());
  claim_cost_.create(rejection.size());
  claim_disparity_px_.create(rejection.size());
  claim_cost_.setTo(Winners::kNoCost);
  for (int y = 0; y < image.height; ++y) {
    const short *costs = winners.cost[y], *disparities_px = winners.disparity_px[y];
    for (int x = 0; x < image.width; ++x) {
      const cv::Point seen = cv::Point(x, y) + view.offsetAt(disparities_px[x]);
      if (!image.contains(seen) || costs[x] >= claim_cost_(seen)) continue;
      claim_cost_(seen) = costs[x];
      claim_disparity_px_(seen) = disparities_px[x];
    }
  }
  for (int y = 0; y < image.height; ++y) {
    const short* disparities_px = winners.disparity_px[y];
    std::uint8_t* rejections = rejection[y];
    for (int x = 0; x < image.width; ++x) {
      if (rejections[x] != codeOf(Rejection::kNone)) continue;
      const cv::Point seen = cv::Point(x, y) + view.offsetAt(disparities_px[x]);
      if (image.contains(seen) && std::abs(claim_disparity_px_(seen) - disparities_px[x]) > tolerance_px)
        rejections[x] = codeOf(Rejection::kLeftRight);
    }
  }
}

}  // namespace cornerstone
