#include "cornerstone/landmarks/edges.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

GridMap rowOf(const std::vector<float>& probabilities) {
  GridMap map;
  map.geometry = {0.1, 0, 0, static_cast<int>(probabilities.size()), 1};
  map.occupied = cv::Mat1f(1, map.geometry.cols);
  for (int i = 0; i < map.geometry.cols; ++i) map.occupied(0, i) = probabilities[static_cast<std::size_t>(i)];
  return map;
}

TEST(CellStates, CertainGrowsIntoUncertainThatLeansItsWay) {
  const cv::Mat1b states = cellStates(rowOf({1.0f, 0.6f, 0.55f, 0.4f, 0.3f, 0.0f}), {});
  const std::vector<int> expected{2, 2, 2, 1, 1, 1};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(states(0, i), expected[static_cast<std::size_t>(i)]) << i;
}

TEST(CellStates, NothingGrowsIntoOrAcrossUnseen) {
  const cv::Mat1b states = cellStates(rowOf({1.0f, kUnseen, 0.6f, kUnseen, 0.0f}), {});
  const std::vector<int> expected{2, 0, 0, 0, 1};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(states(0, i), expected[static_cast<std::size_t>(i)]) << i;
}

TEST(Edges, LieOnTheCellBorderBetweenCertainCells) {
  const GridMap map = rowOf({1.0f, 0.0f, 0.0f});
  const auto edges = findEdges(map, cellStates(map, {}), {});
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_NEAR(edges[0].position_m.x(), 0.1, 1e-6);
  EXPECT_NEAR(edges[0].position_m.y(), 0.05, 1e-6);
  EXPECT_NEAR(edges[0].normal.x(), 1, 1e-6);
}

TEST(Edges, FollowTheProbabilityBelowACell) {
  // One half is crossed at 0.25 of the way from 0.6 (centre 0.15 m) to 0.2 (centre 0.25 m).
  const GridMap map = rowOf({1.0f, 0.6f, 0.2f, 0.0f});
  const auto edges = findEdges(map, cellStates(map, {}), {});
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_NEAR(edges[0].position_m.x(), 0.175, 1e-6);
}

TEST(Edges, NoneBetweenOccupiedAndUnseen) {
  const GridMap map = rowOf({1.0f, kUnseen, 0.0f});
  EXPECT_TRUE(findEdges(map, cellStates(map, {}), {}).empty());
}

}  // namespace
}  // namespace cornerstone
