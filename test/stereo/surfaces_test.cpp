#include "cornerstone/stereo/surfaces.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

const SurfaceParams kParams{6, 2, 1.F};
constexpr auto kStrong = static_cast<std::uint8_t>(Evidence::kStrong);

cv::Mat1b judged(const cv::Mat1f& disparity_px, const cv::Mat1b& evidence) {
  cv::Mat1b verdicts;
  SurfaceFilter().judge(disparity_px, evidence, kParams, verdicts);
  return verdicts;
}

TEST(SurfaceFilter, TellsSmallWeakAndGoodSurfaces) {
  cv::Mat1f disparity_px(8, 12, 0.F);
  cv::Mat1b evidence(8, 12, std::uint8_t{0});
  disparity_px(cv::Rect(0, 0, 2, 2)).setTo(5);   // 4 pixels
  disparity_px(cv::Rect(4, 0, 3, 2)).setTo(5);   // 6 pixels, one strong
  disparity_px(cv::Rect(4, 4, 3, 2)).setTo(5);   // 6 pixels, two strong
  disparity_px(cv::Rect(7, 4, 3, 2)).setTo(10);  // beside it, behind a step
  evidence(0, 4) = evidence(4, 4) = evidence(5, 6) = kStrong;
  const cv::Mat1b verdicts = judged(disparity_px, evidence);
  EXPECT_EQ(verdicts(1, 1), SurfaceFilter::kSmall);
  EXPECT_EQ(verdicts(1, 5), SurfaceFilter::kWeak);
  EXPECT_EQ(verdicts(4, 5), SurfaceFilter::kGood);
  EXPECT_EQ(verdicts(4, 8), SurfaceFilter::kWeak);
  EXPECT_EQ(verdicts(7, 0), SurfaceFilter::kGood);  // no answer, no surface
}

TEST(SurfaceFilter, ArmsThatMeetLaterAreOneSurface) {
  cv::Mat1f disparity_px(5, 7, 0.F);
  cv::Mat1b evidence(5, 7, std::uint8_t{0});
  for (int y = 0; y < 5; ++y) disparity_px(y, 0) = disparity_px(y, 3) = disparity_px(y, 6) = 4;  // three arms
  disparity_px.row(4).setTo(4.5);  // joined below
  evidence(0, 0) = evidence(0, 6) = kStrong;
  const cv::Mat1b verdicts = judged(disparity_px, evidence);
  EXPECT_EQ(cv::countNonZero(verdicts), 0);
}

TEST(SurfaceFilter, SlantedSurfacesHangTogether) {
  cv::Mat1f disparity_px(3, 10);
  for (int x = 0; x < 10; ++x) disparity_px.col(x).setTo(2 + 0.9 * x);
  EXPECT_EQ(cv::countNonZero(judged(disparity_px, cv::Mat1b(3, 10, kStrong))), 0);
  for (int x = 0; x < 10; ++x) disparity_px.col(x).setTo(2 + 1.1 * x);
  EXPECT_EQ(cv::countNonZero(judged(disparity_px, cv::Mat1b(3, 10, kStrong)) == SurfaceFilter::kSmall), 30);
}

}  // namespace
}  // namespace cornerstone
