#include "cornerstone/stereo/pair_cost.h"

#include <gtest/gtest.h>

#include "cornerstone/stereo/census.h"

namespace cornerstone {
namespace {

TEST(Census, IgnoresGainAndOffset) {
  cv::RNG random(1);
  cv::Mat1b image(20, 37), brighter;
  random.fill(image, cv::RNG::UNIFORM, 0, 100);
  image.convertTo(brighter, CV_8U, 2, 30);  // smoothing rounds: checked on the first four bits
  cv::Mat1b census, census_of_brighter;
  CensusTransform transform;
  transform.apply(image, census);
  transform.apply(brighter, census_of_brighter);
  EXPECT_EQ(cv::countNonZero((census & 15) != (census_of_brighter & 15)), 0);
}

TEST(Census, BitsTellWhichSideIsBrighter) {
  cv::Mat1b rising(9, 33);  // brighter to the right, level from top to bottom
  for (int y = 0; y < rising.rows; ++y)
    for (int x = 0; x < rising.cols; ++x) rising(y, x) = static_cast<std::uint8_t>(3 * x);
  cv::Mat1b census;
  CensusTransform().apply(rising, census);
  // Right and right-down rise, down stays, left-down falls; the same at 2 px.
  EXPECT_EQ(census(4, 10), 0b01010101);
  EXPECT_EQ(census(4, 32 - 4), 0b01010101);
}

TEST(PairCost, CountsBitsOfBothCameras) {
  const cv::Mat1b first(1, 40, std::uint8_t{0b00000111}), second(1, 40, std::uint8_t{0b11111111});
  const cv::Mat1b reference(1, 40, std::uint8_t{0});
  cv::Mat1b costs(1, 40, std::uint8_t{99});
  pairCostRow(reference[0], {5, 40, first[0]}, {0, 30, second[0]}, {0, 40}, costs[0]);
  EXPECT_EQ(costs(0, 4), 16);  // only the second sees it: 8 bits, twice
  EXPECT_EQ(costs(0, 5), 11);  // 3 + 8
  EXPECT_EQ(costs(0, 29), 11);
  EXPECT_EQ(costs(0, 30), 6);  // only the first: 3 bits, twice
  EXPECT_EQ(costs(0, 39), 6);
}

TEST(PairCost, UnseenPixelsCostChance) {
  const cv::Mat1b census(1, 40, std::uint8_t{0});
  cv::Mat1b costs(1, 40, std::uint8_t{99});
  pairCostRow(census[0], {3, 40, census[0]}, {}, {0, 40}, costs[0]);
  EXPECT_EQ(costs(0, 2), kCensusBits);
  EXPECT_EQ(costs(0, 3), 0);
}

TEST(PairCost, SeenPartFollowsTheShift) {
  const cv::Mat1b census(30, 40, std::uint8_t{0});
  const SeenRow right = seenRow({census, {-1, 0}}, 10, 7);
  EXPECT_EQ(right.begin, 7);
  EXPECT_EQ(right.end, 40);
  EXPECT_EQ(right.census + 7, census[10]);
  const SeenRow top = seenRow({census, {0, 1}}, 22, 7);
  EXPECT_EQ(top.end, 40);
  EXPECT_EQ(top.census, census[29]);
  EXPECT_EQ(seenRow({census, {0, 1}}, 23, 7).end, 0);  // row 30 is outside
}

}  // namespace
}  // namespace cornerstone
