#include "cornerstone/stereo/stereo_matcher.h"

#include <gtest/gtest.h>

#include <sstream>

#include "cornerstone/base/errors.h"
#include "stereo/synthetic_views.h"

namespace cornerstone {
namespace {

const cv::Size kSize(160, 120);

double shareOf(const Disparity& disparity, Rejection why) {
  return cv::countNonZero(disparity.rejection == static_cast<int>(why)) /
         static_cast<double>(disparity.rejection.total());
}

TEST(StereoMatcher, FindsAKnownShiftWithoutABlindBand) {
  cv::RNG random(1);
  const Texture texture(kSize, 1, 30, random);
  const Disparity disparity = matched(viewsOf(texture, {7, 0}, {2, 1}, random));
  // The right camera does not see columns 0..6, the top camera not rows 113..119: only 7 x 7 px are seen by
  // neither.
  EXPECT_GT(shareOf(disparity, Rejection::kNone), 0.99);
  EXPECT_NEAR(disparity.disparity_px(50, 2), 7, 0.25);
  EXPECT_NEAR(disparity.disparity_px(117, 80), 7, 0.25);
  EXPECT_NEAR(disparity.disparity_px(60, 80), 7, 0.25);
}

TEST(StereoMatcher, NoAnswerIsZeroEverywhere) {
  cv::RNG random(2);
  const Disparity disparity = matched(viewsOf(Texture(kSize, 2, 8, random), {4, 0.05}, {4, 1}, random));
  int answers = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool answered = disparity.rejection(y, x) == 0;
      answers += answered;
      ASSERT_EQ(answered, disparity.disparity_px(y, x) > 0);
      ASSERT_EQ(answered, disparity.sigma_px(y, x) > 0);
    }
  }
  EXPECT_GT(answers, 0);
  EXPECT_LT(answers, kSize.area());
}

TEST(StereoMatcher, GainDifferenceChangesLittle) {
  cv::RNG random(3);
  const Texture texture(kSize, 1, 30, random);
  const Disparity disparity = matched(viewsOf(texture, {5.5, 0}, {2, 0.85}, random));
  EXPECT_GT(shareOf(disparity, Rejection::kNone), 0.98);
  EXPECT_NEAR(cv::mean(disparity.disparity_px, disparity.rejection == 0)[0], 5.5, 0.02);
}

TEST(StereoMatcher, SurfaceHiddenFromOneCameraIsRefusedOrRight) {
  cv::RNG random(4);
  const Texture behind(kSize, 1, 30, random), front(kSize, 1, 30, random);
  StereoImages images = viewsOf(behind, {3, 0}, {2, 1}, random);
  const StereoImages near = viewsOf(front, {13, 0}, {2, 1}, random);
  const cv::Rect box(60, 40, 40,
                     40);  // in the reference image; it hides columns 50..59 from the right camera
  near.reference(box).copyTo(images.reference(box));
  near.right(box - cv::Point(13, 0)).copyTo(images.right(box - cv::Point(13, 0)));
  near.top(box + cv::Point(0, 13)).copyTo(images.top(box + cv::Point(0, 13)));
  const Disparity disparity = matched(images);
  int wrong = 0, answered = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      if (disparity.rejection(y, x) != 0) continue;
      ++answered;
      wrong += std::abs(disparity.disparity_px(y, x) - (box.contains({x, y}) ? 13 : 3)) > 1;
    }
  }
  EXPECT_GT(answered, 0.85 * kSize.area());
  EXPECT_LT(wrong, 0.01 * kSize.area());
  EXPECT_NEAR(disparity.disparity_px(60, 80), 13, 0.3);
  // The right camera sees the box where the top one still sees what is behind.
  const cv::Rect hidden(51, 44, 8, 32);
  const auto countOf = [&](const Disparity& of, Rejection why) {
    return cv::countNonZero(of.rejection(hidden) == static_cast<int>(why));
  };
  EXPECT_GT(countOf(disparity, Rejection::kPairs), 0.5 * hidden.area());
  EXPECT_LT(countOf(disparity, Rejection::kLeftRight), 0.1 * hidden.area());
  images.top.release();
  const Disparity of_pair = matched(images);
  EXPECT_EQ(shareOf(of_pair, Rejection::kPairs), 0);
  EXPECT_GT(countOf(of_pair, Rejection::kLeftRight), 0.3 * hidden.area());
}

// A textured thing before a wall that shows nothing: only its outline, which the windows reach beyond.
TEST(StereoMatcher, ThingBeforeABareWallEndsAtItsOutline) {
  const cv::Rect thing(60, 40, 40, 40);
  for (const bool third : {false, true}) {
    cv::RNG random(16);
    const StereoImages near = viewsOf(Texture(kSize, 1, 30, random), {13, 0}, {2, 1}, random);
    cv::Mat1f wall(kSize, 40.F);
    StereoImages images{photographed(wall, 2, 1, random), photographed(wall, 2, 1, random), {}};
    near.reference(thing).copyTo(images.reference(thing));
    near.right(thing - cv::Point(13, 0)).copyTo(images.right(thing - cv::Point(13, 0)));
    if (third) {
      images.top = photographed(wall, 2, 1, random);
      near.top(thing + cv::Point(0, 13)).copyTo(images.top(thing + cv::Point(0, 13)));
    }
    const Disparity disparity = matched(images);
    cv::Mat1b answered(disparity.rejection == 0);
    EXPECT_GT(cv::countNonZero(answered(thing)), 0.95 * thing.area());
    const cv::Rect with_blur(58, 38, 44, 44);
    answered(with_blur).setTo(0);
    EXPECT_LT(cv::countNonZero(answered), third ? 40 : 80);  // the windows alone: 136 and 198 pixels
  }
}

TEST(StereoMatcher, BareWallIsRefused) {
  const cv::Mat1f wall(kSize, 130.F);
  for (const std::uint64_t seed : {5u, 15u, 25u}) {
    cv::RNG random(seed);
    StereoImages images{photographed(wall, 2, 1, random), photographed(wall, 2, 1, random),
                        photographed(wall, 2, 1, random)};
    EXPECT_EQ(shareOf(matched(images), Rejection::kNone), 0) << "three cameras, seed " << seed;
    EXPECT_GT(shareOf(matched(images), Rejection::kTexture), 0.45) << "three cameras, seed " << seed;
    images.top.release();
    EXPECT_EQ(shareOf(matched(images), Rejection::kNone), 0) << "two cameras, seed " << seed;
  }
  const cv::Mat1b without_noise(kSize, 90);
  EXPECT_EQ(shareOf(matched({without_noise, without_noise, {}}), Rejection::kNone), 0);
}

// The windows of large images, which tell patterns from bare walls; small images get smaller ones.
StereoParams wideWindow() {
  StereoParams params;
  params.window_px = 7;
  return params;
}

TEST(StereoMatcher, RepetitivePatternIsRefusedForItsUniqueness) {
  cv::RNG random(9);
  cv::Mat1f stripes(kSize), shifted(kSize);  // period 8 px: disparities 3, 11, 19, 27 match alike
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      stripes(y, x) = static_cast<float>(128 + 60 * std::sin(2 * M_PI * x / 8));
      shifted(y, x) = static_cast<float>(128 + 60 * std::sin(2 * M_PI * (x + 3) / 8));
    }
  }
  const Disparity disparity =
      matched({photographed(stripes, 2, 1, random), photographed(shifted, 2, 1, random), {}}, wideWindow());
  const cv::Mat middle =
      disparity.rejection(cv::Rect(40, 10, 100, 100)) == static_cast<int>(Rejection::kUniqueness);
  EXPECT_GT(cv::countNonZero(middle), 0.6 * 100 * 100);  // others fail other checks
  EXPECT_LT(shareOf(disparity, Rejection::kNone), 0.1);
}

TEST(StereoMatcher, TopCameraSeesHorizontalStripes) {
  cv::RNG random(6);
  cv::Mat1f levels(kSize.height + 20, 1), reference(kSize), top(kSize);
  random.fill(levels, cv::RNG::UNIFORM, 60, 190);
  cv::GaussianBlur(levels, levels, {1, 5}, 1);
  for (int y = 0; y < kSize.height; ++y) {
    reference.row(y).setTo(levels(y + 10, 0));
    top.row(y).setTo(levels(y + 10 - 4, 0));  // disparity 4: seen 4 rows lower
  }
  StereoImages images{photographed(reference, 1, 1, random), photographed(reference, 1, 1, random),
                      photographed(top, 1, 1, random)};
  const Disparity three = matched(images, wideWindow());
  EXPECT_GT(shareOf(three, Rejection::kNone), 0.75);  // some rows do resemble others
  EXPECT_NEAR(three.disparity_px(60, 80), 4, 0.3);
  images.top.release();
  EXPECT_LT(shareOf(matched(images, wideWindow()), Rejection::kNone), 0.02);
}

TEST(StereoMatcher, ThirdCameraMayStandAnywhereOnAnAxis) {
  // Bottom, left, a second right one twice as far, a top one at 0.75 of the baseline.
  for (const cv::Point2d shift : {cv::Point2d(0, -1), {1, 0}, {-2, 0}, {0, 0.75}}) {
    cv::RNG random(12);
    const Texture texture(kSize, 1, 30, random);
    StereoImages images = viewsOf(texture, {6.3, 0}, {2, 1}, random);
    cv::Mat1f third(kSize);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) third(y, x) = texture.at(x - 6.3 * shift.x, y - 6.3 * shift.y);
    images.top = photographed(third, 2, 1, random);
    TrinocularRig rig = rigOf(images);
    rig.top_shift = shift;
    const Disparity disparity = StereoMatcher(StereoParams()).match(images, rig);
    EXPECT_GT(shareOf(disparity, Rejection::kNone), 0.93) << shift;
    EXPECT_NEAR(cv::mean(disparity.disparity_px, disparity.rejection == 0)[0], 6.3, 0.1) << shift;
  }
}

// All that one answer holds, bit by bit.
void expectSame(const Disparity& one, const Disparity& other, const std::string& what) {
  EXPECT_EQ(cv::norm(one.disparity_px, other.disparity_px, cv::NORM_INF), 0) << what;
  EXPECT_EQ(cv::norm(one.sigma_px, other.sigma_px, cv::NORM_INF), 0) << what;
  EXPECT_EQ(cv::norm(one.rejection, other.rejection, cv::NORM_INF), 0) << what;
}

TEST(StereoMatcher, AnswersAreTheSameWithAnyNumberOfThreads) {
  cv::RNG random(18);
  const StereoImages far = viewsOf(Texture(kSize, 1, 30, random), {3, 0.02}, {3, 1}, random);
  const StereoImages near = viewsOf(Texture(kSize, 2, 6, random), {13, 0}, {3, 1}, random);
  StereoImages images = far;  // with depth steps, and texture too weak for an answer everywhere
  const cv::Rect box(60, 40, 40, 40);
  near.reference(box).copyTo(images.reference(box));
  near.right(box - cv::Point(13, 0)).copyTo(images.right(box - cv::Point(13, 0)));
  near.top(box + cv::Point(0, 13)).copyTo(images.top(box + cv::Point(0, 13)));
  for (const cv::Size size : {kSize, cv::Size(333, 241), cv::Size(40, 7), cv::Size(9, 30), cv::Size(1, 1)})
    for (const cv::Point2d third : {cv::Point2d(0, 1), {0, -0.75}, {-2, 0}, {0, 0}}) {
      StereoImages resized;
      cv::resize(images.reference, resized.reference, size);
      cv::resize(images.right, resized.right, size);
      if (third != cv::Point2d()) cv::resize(images.top, resized.top, size);
      TrinocularRig rig = rigOf(resized);
      if (rig.top_shift) rig.top_shift = third;
      StereoParams params;
      const Disparity alone = StereoMatcher(params).match(resized, rig);
      for (params.threads = 2; params.threads <= 5; ++params.threads) {
        StereoMatcher matcher(params);
        for (int turn = 0; turn < 3; ++turn) {
          std::ostringstream what;
          what << size << " third camera " << third << ", " << params.threads << " threads, turn " << turn;
          expectSame(matcher.match(resized, rig), alone, what.str());
        }
      }
    }
}

TEST(StereoMatcher, BuffersOfOneFrameDoNotReachTheNext) {
  cv::RNG random(13);
  const StereoImages first = viewsOf(Texture(kSize, 1, 30, random), {5, 0}, {2, 1}, random);
  const StereoImages second = viewsOf(Texture(kSize, 1, 30, random), {9.5, 0}, {2, 1}, random);
  StereoMatcher matcher{StereoParams()};
  Disparity disparity;
  matcher.match(first, rigOf(first), disparity);
  matcher.match(second, rigOf(second), disparity);
  const Disparity fresh = matched(second);
  EXPECT_EQ(cv::norm(disparity.disparity_px, fresh.disparity_px, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(disparity.sigma_px, fresh.sigma_px, cv::NORM_INF), 0);
}

TEST(StereoMatcher, ImagesThatDoNotFitTheRigMatchNowhere) {
  cv::RNG random(14);
  StereoImages images = viewsOf(Texture(kSize, 1, 30, random), {7, 0}, {2, 1}, random);
  EXPECT_GT(matchedShare(matched(images)).value(), 0.9);
  std::swap(images.reference, images.right);  // the top camera contradicts, too
  EXPECT_LT(matchedShare(matched(images)).value(), 0.05);
  images.top.release();
  EXPECT_LT(matchedShare(matched(images)).value(), 0.05);
  const cv::Mat1b bare(kSize, 90);
  EXPECT_FALSE(matchedShare(matched({bare, bare, {}})));
}

TEST(StereoMatcher, NearerThanTheRangeIsRefused) {
  cv::RNG random(7);
  StereoParams params;
  params.max_disparity_px = 8;
  const Disparity disparity =
      matched(viewsOf(Texture(kSize, 1, 30, random), {9.4, 0}, {2, 1}, random), params);
  EXPECT_LT(shareOf(disparity, Rejection::kNone), 0.01);
  EXPECT_GT(shareOf(disparity, Rejection::kRange), 0.5);
}

TEST(StereoMatcher, RefusesBadImagesAndParameters) {
  const cv::Mat1b image(kSize, 0);
  EXPECT_THROW(matched({image, cv::Mat1b(), {}}), InputError);
  EXPECT_THROW(matched({image, cv::Mat1b(60, 80), {}}), InputError);
  StereoMatcher matcher{StereoParams()};
  TrinocularRig two_cameras;
  two_cameras.image_size_px = kSize;
  EXPECT_THROW(matcher.match({image, image, image}, two_cameras), InputError);
  StereoParams even;
  even.window_px = 8;
  EXPECT_THROW(StereoMatcher{even}, InputError);
  StereoParams nobody;
  nobody.threads = 0;
  EXPECT_THROW(StereoMatcher{nobody}, InputError);
}

TEST(StereoMatcher, AnyImageSizeWorks) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(5, 3), cv::Size(17, 33), cv::Size(161, 119)}) {
    cv::Mat1b image(size);
    cv::RNG(8).fill(image, cv::RNG::UNIFORM, 0, 255);
    const Disparity disparity = matched({image, image, image});
    EXPECT_EQ(disparity.disparity_px.size(), size);
  }
}

}  // namespace
}  // namespace cornerstone
