#include "cornerstone/stereo/gradient_features.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

cv::Mat1b rising(int per_column) {  // brighter to the right, level from top to bottom
  cv::Mat1b image(9, 33);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) image(y, x) = static_cast<std::uint8_t>(20 + per_column * x);
  return image;
}

Workers one_thread(1);

TEST(GradientFeatures, TellDirectionAndSizeOfDifferences) {
  GradientFeatures features;
  features.compute(rising(2), one_thread);
  // To the right: 4 grey levels at 1 px against a noise of 4: 15.5 (1 + 4 / 8) = 23; 8 at 2 px against 2: 28.
  EXPECT_EQ(features.channel(0)(4, 16), 23);
  EXPECT_EQ(features.channel(2)(4, 16), 28);
  // Down: none, 15.5 rounded.
  EXPECT_EQ(features.channel(1)(4, 16), 16);
  EXPECT_EQ(features.channel(3)(4, 16), 16);
}

TEST(GradientFeatures, OffsetChangesNothingAndGainLittle) {
  cv::RNG random(1);
  cv::Mat1b image(20, 37), brighter, louder;
  random.fill(image, cv::RNG::UNIFORM, 0, 150);
  image.convertTo(brighter, CV_8U, 1, 30);
  image.convertTo(louder, CV_8U, 1.3);
  GradientFeatures features, of_brighter, of_louder;
  features.compute(image, one_thread);
  of_brighter.compute(brighter, one_thread);
  of_louder.compute(louder, one_thread);
  for (std::size_t c = 0; c < GradientFeatures::kChannels; ++c) {
    EXPECT_EQ(cv::norm(features.channel(c), of_brighter.channel(c), cv::NORM_INF), 0) << c;
    // Smoothing rounds, so that the smallest differences change sign.
    EXPECT_LE(cv::norm(features.channel(c), of_louder.channel(c), cv::NORM_INF), c < 2 ? 2 : 6) << c;
  }
}

TEST(GradientFeatures, CostsOfAPlaneAreThoseOfItsPixels) {
  cv::RNG random(2);
  cv::Mat1b image(12, 21), other(12, 21);
  random.fill(image, cv::RNG::UNIFORM, 0, 255);
  random.fill(other, cv::RNG::UNIFORM, 0, 255);
  GradientFeatures here, there;
  here.compute(image, one_thread);
  there.compute(other, one_thread);
  const cv::Point offset(-3, 2);
  cv::Mat1b costs(image.size(), std::uint8_t{255});
  for (int y = 0; y < image.rows; ++y) here.costsOfRow(y, there, offset, costs[y]);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const bool seen = x >= 3 && y < 10;
      if (x == 12 && y == 5) {
        int around = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            around += here.costAt(cv::Point(x + dx, y + dy), there, cv::Point(x + dx, y + dy) + offset);
        EXPECT_EQ(here.costAround({x, y}, there, cv::Point(x, y) + offset), around);
      }
      ASSERT_EQ(costs(y, x), seen ? here.costAt({x, y}, there, cv::Point(x, y) + offset) : 255)
          << x << ' ' << y;
    }
}

}  // namespace
}  // namespace cornerstone
