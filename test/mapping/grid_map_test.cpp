#include "cornerstone/mapping/grid_map.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

TEST(GridMap, KnownCentreIsTheMeanOfTheSeenCells) {
  GridMap map;
  map.geometry = {0.5, 10, 20, 4, 2};
  map.occupied = cv::Mat1f(2, 4, kUnseen);
  EXPECT_NEAR(knownCentre(map).norm(), 0, 1e-12);
  map.occupied(1, 1) = 0.1f;
  map.occupied(1, 3) = 0.9f;
  EXPECT_NEAR(knownCentre(map).x(), 11.25, 1e-9);  // between the cells at 10.75 and 11.75 m
  EXPECT_NEAR(knownCentre(map).y(), 20.75, 1e-9);
  EXPECT_NEAR(knownCentre(GridMap{}).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace cornerstone
