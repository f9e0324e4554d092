#include "cornerstone/stereo/coarse_fill.h"

#include <gtest/gtest.h>

#include "stereo/synthetic_views.h"

namespace cornerstone {
namespace {

const cv::Size kSize(640, 480);
constexpr double kFar_px = 10;
// So near that its texture is blurred over 8 px and weak (5 grey levels), a wall stands before the lower half
// of the view.
const cv::Rect kNear(0, 240, 640, 240);

// What 160x120 images show, blurred and without noise, four times as large.
StereoImages enlarged(const StereoImages& small) {
  StereoImages images;
  cv::resize(small.reference, images.reference, kSize, 0, 0, cv::INTER_CUBIC);
  cv::resize(small.right, images.right, kSize, 0, 0, cv::INTER_CUBIC);
  return images;
}

cv::Mat1b withNoise(const cv::Mat1b& image, cv::RNG& random) {
  cv::Mat1f grey;
  image.convertTo(grey, CV_32F);
  return photographed(grey, 2, 1, random);
}

StereoImages withNoise(const StereoImages& images, cv::RNG& random) {
  return {withNoise(images.reference, random), withNoise(images.right, random), {}};
}

// Sharp texture everywhere, at one disparity.
StereoImages farWall(cv::RNG& random) {
  cv::Mat1f grey(kSize + cv::Size(64, 0));
  random.fill(grey, cv::RNG::NORMAL, 0, 60);
  cv::GaussianBlur(grey, grey, {}, 1);
  grey += 120;
  StereoImages images;
  grey.colRange(0, kSize.width).convertTo(images.reference, CV_8U);
  grey.colRange(static_cast<int>(kFar_px), static_cast<int>(kFar_px) + kSize.width)
      .convertTo(images.right, CV_8U);
  return images;
}

StereoImages nearWallBeforeAFarOne(double near_px) {
  cv::RNG random(3);
  const Texture texture({160, 120}, 2, 5, random);
  const StereoImages near = enlarged(viewsOf(texture, {near_px / 4, 0}, {0, 1}, random));
  StereoImages images = farWall(random);
  near.reference(kNear).copyTo(images.reference(kNear));
  near.right(kNear).copyTo(images.right(kNear));
  return withNoise(images, random);
}

StereoParams withLevel(bool coarse_level) {
  StereoParams params;
  params.max_disparity_px = 96;
  params.coarse_level = coarse_level;
  return params;
}

// Of the columns that both cameras see, those that show an answer near the wall's true disparity.
double shareOfColumnsSeeing(double near_px, const Disparity& disparity) {
  int seeing = 0, columns = 0;
  for (int x = static_cast<int>(near_px) + 16; x < kSize.width - 16; ++x) {
    const cv::Mat column = disparity.disparity_px(kNear).col(x);
    ++columns;
    seeing += cv::countNonZero(cv::abs(column - near_px) < 2) > 20;
  }
  return static_cast<double>(seeing) / columns;
}

TEST(CoarseFill, NearWallOfBlurredTextureIsSeen) {
  const StereoImages images = nearWallBeforeAFarOne(82);
  EXPECT_LT(shareOfColumnsSeeing(82, matched(images, withLevel(false))), 0.5);  // the fault
  const Disparity disparity = matched(images, withLevel(true));
  EXPECT_GT(shareOfColumnsSeeing(82, disparity), 0.95);
  const cv::Mat1f far = disparity.disparity_px(cv::Rect(16, 16, 608, 190));
  EXPECT_EQ(cv::countNonZero(far > kFar_px + 1), 0);
}

TEST(CoarseFill, SigmaIsThatOfTheCoarsePixels) {
  const StereoImages images = nearWallBeforeAFarOne(82);
  const cv::Rect wall(100, 270, 500, 190);
  const Disparity fine = matched(images, withLevel(false)), both = matched(images, withLevel(true));
  int filled = 0, within_1 = 0, within_2 = 0;
  for (int y = wall.y; y < wall.br().y; ++y)
    for (int x = wall.x; x < wall.br().x; ++x) {
      if (fine.rejection(y, x) == 0 || both.rejection(y, x) != 0) continue;
      const double error_px = std::abs(both.disparity_px(y, x) - 82);
      ++filled;
      within_1 += error_px < both.sigma_px(y, x);
      within_2 += error_px < 2 * both.sigma_px(y, x);
    }
  EXPECT_GT(filled, 0.3 * wall.area());
  EXPECT_GT(within_1, 0.6 * filled);
  EXPECT_GT(within_2, 0.93 * filled);
}

TEST(CoarseFill, SeesWhatIsNearerThanTheRange) {
  const StereoImages images = nearWallBeforeAFarOne(108);
  EXPECT_EQ(shareOfColumnsSeeing(108, matched(images, withLevel(false))), 0);
  EXPECT_GT(shareOfColumnsSeeing(108, matched(images, withLevel(true))), 0.95);
  EXPECT_EQ(StereoMatcher(withLevel(true)).largest_px(kSize), 128);
  EXPECT_EQ(StereoMatcher(withLevel(true)).largest_px({320, 240}), 96);
  EXPECT_EQ(StereoMatcher(withLevel(false)).largest_px(kSize), 96);
}

// Coarse windows reach four times as far over the outline.
TEST(CoarseFill, ThingBeforeABareWallGrowsNoFarther) {
  cv::RNG random(5);
  const cv::Rect thing(240, 160, 160, 160);
  const Texture texture({160, 120}, 1, 30, random);
  const StereoImages near = enlarged(viewsOf(texture, {12, 0}, {0, 1}, random));
  StereoImages images{cv::Mat1b(kSize, 90), cv::Mat1b(kSize, 90), {}};
  near.reference(thing).copyTo(images.reference(thing));
  near.right(thing - cv::Point(48, 0)).copyTo(images.right(thing - cv::Point(48, 0)));
  images = withNoise(images, random);
  const auto outside = [&](bool coarse_level) {
    cv::Mat1b answered(matched(images, withLevel(coarse_level)).rejection == 0);
    answered(thing).setTo(0);
    return cv::countNonZero(answered);
  };
  EXPECT_LE(outside(true), outside(false) + 100);
}

TEST(CoarseFill, BareWallsStaySilent) {
  cv::RNG random(6);
  const StereoImages images = withNoise({cv::Mat1b(kSize, 130), cv::Mat1b(kSize, 130), {}}, random);
  EXPECT_EQ(cv::countNonZero(matched(images, withLevel(true)).rejection == 0), 0);
}

TEST(CoarseFill, SmallImagesAreAsWithout) {
  StereoImages images = nearWallBeforeAFarOne(82);
  cv::resize(images.reference, images.reference, {320, 240}, 0, 0, cv::INTER_AREA);
  cv::resize(images.right, images.right, {320, 240}, 0, 0, cv::INTER_AREA);
  const Disparity with = matched(images, withLevel(true)), without = matched(images, withLevel(false));
  EXPECT_EQ(cv::norm(with.disparity_px, without.disparity_px, cv::NORM_INF), 0);
}

TEST(CoarseFill, AnswersAreTheSameWithAnyNumberOfThreads) {
  const StereoImages images = nearWallBeforeAFarOne(82);
  StereoParams params = withLevel(true);
  const Disparity alone = matched(images, params);
  params.threads = 3;
  const Disparity together = matched(images, params);
  EXPECT_EQ(cv::norm(alone.disparity_px, together.disparity_px, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(alone.sigma_px, together.sigma_px, cv::NORM_INF), 0);
}

TEST(CoarseFill, ShrinksToMeans) {
  cv::Mat1b image(9, 14, std::uint8_t{7}), shrunk;
  image(1, 1) = 7 + 40;
  CoarseFill::shrink(image, shrunk);
  EXPECT_EQ(shrunk.size(), cv::Size(3, 2));
  EXPECT_EQ(shrunk(0, 0), 10);  // 7 + 2.5, rounded
  EXPECT_EQ(shrunk(1, 2), 7);
}

}  // namespace
}  // namespace cornerstone
