// Sub-pixel figures on surfaces of known disparity at the product's size: 160x120, noise 2 grey levels, gain
// 5%.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "stereo/synthetic_views.h"

namespace cornerstone {
namespace {

struct ErrorFigures {
  double answers = 0, bias_px = 0, rms_px = 0, within_sigma = 0, within_two_sigma = 0;
};

ErrorFigures figuresOf(const Surface& surface, double blur_px, double contrast) {
  cv::RNG random(11);
  const Texture texture({160, 120}, blur_px, contrast, random);
  const Disparity disparity = matched(viewsOf(texture, surface, {2, 0.95}, random));
  ErrorFigures figures;
  for (int y = 0; y < disparity.disparity_px.rows; ++y) {
    for (int x = 0; x < disparity.disparity_px.cols; ++x) {
      if (disparity.rejection(y, x) != 0) continue;
      const double error = disparity.disparity_px(y, x) - surface.disparityAt(x),
                   sigma = disparity.sigma_px(y, x);
      figures.answers += 1;
      figures.bias_px += error;
      figures.rms_px += error * error;
      figures.within_sigma += std::abs(error) <= sigma;
      figures.within_two_sigma += std::abs(error) <= 2 * sigma;
    }
  }
  figures.bias_px /= figures.answers;
  figures.rms_px = std::sqrt(figures.rms_px / figures.answers);
  figures.within_sigma /= figures.answers;
  figures.within_two_sigma /= figures.answers;
  return figures;
}

TEST(Subpixel, BiasIsSmallAtEveryFractionOfAPixel) {
  for (const double fraction : {0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}) {
    const ErrorFigures figures = figuresOf({3 + fraction, 0}, 1.5, 20);
    EXPECT_NEAR(figures.bias_px, 0, 0.04) << "at 3 + " << fraction;
    EXPECT_LT(figures.rms_px, 0.1) << "at 3 + " << fraction;
  }
}

TEST(Subpixel, SmallDisparitiesAreAnswered) {
  const ErrorFigures figures = figuresOf({1.2, 0}, 1.5, 20);
  EXPECT_GT(figures.answers, 0.98 * 160 * 120);
  EXPECT_NEAR(figures.bias_px, 0, 0.04);
  EXPECT_LT(figures.rms_px, 0.12);
}

TEST(Subpixel, SlantedSurfaceKeepsItsSlope) {
  const ErrorFigures figures = figuresOf({2, 0.05}, 1.5, 20);  // 2 to 10 px over the image
  EXPECT_GT(figures.answers, 0.97 * 160 * 120);
  EXPECT_NEAR(figures.bias_px, 0, 0.03);
  EXPECT_LT(figures.rms_px, 0.1);
}

// Fits near whole pixels are the surest where cameras are quiet: an average that leant on them would draw all
// others there, and walls seen at a slant would come out in steps.
TEST(Subpixel, SlantedSurfaceIsNotDrawnToWholePixels) {
  const Surface surface{2, 0.115};  // a corridor's wall
  cv::RNG random(11);
  const Disparity disparity = matched(viewsOf(Texture({160, 120}, 1.5, 20, random), surface, {0, 1}, random));
  std::array<double, 8> sums{}, counts{};
  for (int y = 8; y < 112; ++y) {
    for (int x = 24; x < 152; ++x) {
      if (disparity.rejection(y, x) != 0) continue;
      const double truth_px = surface.disparityAt(x);
      const auto part = static_cast<std::size_t>(8 * (truth_px - std::floor(truth_px)));
      sums[part] += disparity.disparity_px(y, x) - truth_px;
      counts[part] += 1;
    }
  }
  for (std::size_t part = 0; part < 8; ++part) {
    ASSERT_GT(counts[part], 500);
    EXPECT_NEAR(sums[part] / counts[part], 0, 0.02) << "at fractions from " << static_cast<double>(part) / 8;
  }
}

TEST(Subpixel, SigmaIsHonest) {
  for (const Surface& surface : {Surface{3.3, 0.01}, {2, 0.05}, {1, 0.15}})
    for (const double contrast : {1.5, 3.0, 6.0}) {
      const ErrorFigures figures = figuresOf(surface, 1.5, contrast);
      EXPECT_GT(figures.within_sigma, 0.62) << surface.slope << ' ' << contrast;
      EXPECT_LT(figures.within_sigma, 0.8) << surface.slope << ' ' << contrast;
      EXPECT_GT(figures.within_two_sigma, 0.92) << surface.slope << ' ' << contrast;
    }
  // Without faults of rectification and with much texture the floor is what is left of it.
  const ErrorFigures figures = figuresOf({2, 0.05}, 1.5, 20);
  EXPECT_LT(figures.within_sigma, 0.9);
}

}  // namespace
}  // namespace cornerstone
