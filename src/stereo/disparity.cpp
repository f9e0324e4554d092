#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

void reject(Disparity& disparity, cv::Point at, Rejection why) {
  disparity.disparity_px(at) = 0;
  disparity.sigma_px(at) = 0;
  disparity.rejection(at) = static_cast<std::uint8_t>(why);
}

std::optional<double> matchedShare(const Disparity& disparity) {
  constexpr double kLeastTexture = 0.05;  // of the image
  const auto countOf = [&](Rejection why) {
    return cv::countNonZero(disparity.rejection == static_cast<int>(why));
  };
  const auto pixels = static_cast<double>(disparity.rejection.total());
  const double with_texture = pixels - countOf(Rejection::kTexture) - countOf(Rejection::kOutside);
  if (with_texture < kLeastTexture * pixels || with_texture <= 0) return std::nullopt;
  return countOf(Rejection::kNone) / with_texture;
}

}  // namespace cornerstone
