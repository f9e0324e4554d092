#include "cornerstone/registration/merge_maps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

GridMap mapOf(int cols, int rows, float value) {
  GridMap map;
  map.geometry = {0.5, 0, 0, cols, rows};
  map.occupied = cv::Mat1f(rows, cols, value);
  return map;
}

TEST(MergeMaps, GrowsToHoldBothAndPlacesTheCurrentMap) {
  const GridMap reference = mapOf(4, 4, 0.1f);  // 2 m x 2 m
  GridMap current = mapOf(2, 2, 0.2f);          // 1 m x 1 m
  current.occupied(0, 0) = 0.9f;
  // Turned by 90 degrees and moved right of the reference map: its first cell becomes the lower right one.
  const GridMap merged = mergeMaps(reference, {{current, {4, 0, M_PI / 2}}});
  EXPECT_EQ(merged.geometry.cols, 8);
  EXPECT_EQ(merged.geometry.rows, 4);
  EXPECT_NEAR(merged.occupied(0, 0), 0.1f, 1e-6f);
  EXPECT_NEAR(merged.occupied(0, 7), 0.9f, 1e-6f);
  EXPECT_NEAR(merged.occupied(1, 7), 0.2f, 1e-6f);
  EXPECT_EQ(merged.occupied(0, 5), kUnseen);
  EXPECT_EQ(merged.occupied(3, 7), kUnseen);
}

TEST(MergeMaps, AddsEvidenceWhereBothHaveSeen) {
  const GridMap merged = mergeMaps(mapOf(1, 1, 0.8f), {{mapOf(1, 1, 0.8f), {}}});
  EXPECT_NEAR(merged.occupied(0, 0), 0.64f / (0.64f + 0.04f), 1e-5f);  // 4:1 twice is 16:1
  EXPECT_NEAR(mergeMaps(mapOf(1, 1, kUnseen), {{mapOf(1, 1, 0.8f), {}}}).occupied(0, 0), 0.8f, 1e-6f);
}

TEST(MergeMaps, AnEmptyMapAddsNothing) {
  const GridMap merged = mergeMaps(mapOf(2, 1, 0.7f), {{GridMap{}, {}}});
  EXPECT_EQ(merged.geometry.cols, 2);
  EXPECT_NEAR(merged.occupied(0, 1), 0.7f, 1e-6f);
}

TEST(MergeMaps, HoldsEveryRobotOnEverySideOfTheReference) {
  // One map 2 m to the left, one 1 m below: the result spans 6 x 4 cells of 0.5 m.
  const GridMap merged =
      mergeMaps(mapOf(2, 2, 0.1f), {{mapOf(2, 2, 0.8f), {-2, 0, 0}}, {mapOf(2, 2, 0.9f), {0, -1, 0}}});
  EXPECT_EQ(merged.geometry.cols, 6);
  EXPECT_EQ(merged.geometry.rows, 4);
  EXPECT_NEAR(merged.geometry.origin_x_m, -2, 1e-12);
  EXPECT_NEAR(merged.geometry.origin_y_m, -1, 1e-12);
  EXPECT_NEAR(merged.occupied(2, 0), 0.8f, 1e-6f);
  EXPECT_NEAR(merged.occupied(0, 4), 0.9f, 1e-6f);
  EXPECT_NEAR(merged.occupied(2, 4), 0.1f, 1e-6f);
  EXPECT_EQ(merged.occupied(0, 0), kUnseen);
}

}  // namespace
}  // namespace cornerstone
