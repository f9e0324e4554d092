#include "cornerstone/stereo/validation.h"

#include <cstdlib>

namespace cornerstone {
namespace {

std::uint8_t codeOf(Rejection rejection) { return static_cast<std::uint8_t>(rejection); }

Rejection checkPixel(const Winners& winners, cv::Point at, int max_disparity_px, double largest_cost_ratio) {
  const short cost = winners.cost(at), disparity_px = winners.disparity_px(at);
  if (cost == Winners::kNoCost) return Rejection::kOutside;
  if (cost >= largest_cost_ratio * winners.second_cost(at)) return Rejection::kUniqueness;
  if (disparity_px <= 0 || disparity_px > max_disparity_px) return Rejection::kRange;
  return Rejection::kNone;
}

}  // namespace

void Validator::check(const Winners& winners, const SweepInput& input, const ValidationParams& params,
                      cv::Mat1b& rejection) {
  const cv::Size size = input.reference_census->size();
  rejection.create(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      rejection(y, x) =
          codeOf(checkPixel(winners, {x, y}, input.max_disparity_px, params.largest_cost_ratio));
  for (const SecondaryView& view : input.views)
    checkSecondary(winners, view, params.left_right_tolerance_px, rejection);
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
