#include "cornerstone/ros/grid_messages.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

GridMap smallMap() {
  GridMap map;
  map.geometry = {0.05, -1, 2, 3, 2};
  map.occupied = (cv::Mat1f(2, 3) << 0.f, kUnseen, 1.f, 0.25f, 0.75f, 0.498f);
  return map;
}

TEST(GridMessages, OccupancyGridIsPercentAndUnseenIsMinusOne) {
  const auto grid = toOccupancyGrid(smallMap(), {});
  EXPECT_EQ(grid.info.width, 3u);
  EXPECT_NEAR(grid.info.origin.position.y, 2, 1e-12);
  const std::vector<std::int8_t> expected{0, -1, 100, 25, 75, 50};
  EXPECT_EQ(grid.data, expected);
  const GridMap back = fromOccupancyGrid(grid);
  EXPECT_EQ(back.occupied(0, 1), kUnseen);
  EXPECT_NE(back.occupied(1, 2), kUnseen) << "seen but undecided is not the same as never seen";
  EXPECT_NEAR(back.occupied(1, 1), 0.75f, 1e-6f);
}

TEST(GridMessages, UpdateHoldsOneRectangle) {
  const auto update = toUpdate(smallMap(), {1, 0, 2, 2}, {});
  const std::vector<std::int8_t> expected{-1, 100, 75, 50};
  EXPECT_EQ(update.data, expected);
  GridMap map = smallMap();
  map.occupied.setTo(0);
  applyUpdate(update, map);
  EXPECT_NEAR(map.occupied(0, 2), 1, 1e-6f);
  EXPECT_EQ(map.occupied(0, 0), 0);
}

TEST(GridMessages, RefusesMessagesThatDoNotFit) {
  auto grid = toOccupancyGrid(smallMap(), {});
  grid.data.pop_back();
  EXPECT_THROW(fromOccupancyGrid(grid), InputError);
  auto update = toUpdate(smallMap(), {1, 0, 2, 2}, {});
  update.x = 2;
  GridMap map = smallMap();
  EXPECT_THROW(applyUpdate(update, map), InputError);
}

TEST(GridMessages, TilesKeepProbabilityToHalfAStepAndUnseenExactly) {
  cv::Mat1f tile(4, 4, kUnseen);
  tile(0, 0) = 0.f;
  tile(0, 1) = 1.f;
  tile(3, 3) = 0.3f;
  tile(2, 0) = 0.5001f;
  const MapTile message = toTile(tile, -8, 4);
  EXPECT_EQ(message.col, -8);
  EXPECT_EQ(message.size, 4);
  const cv::Mat1f back = fromTile(message);
  EXPECT_EQ(back(1, 1), kUnseen);
  EXPECT_NE(back(2, 0), kUnseen);
  EXPECT_NEAR(back(0, 0), 0, 1e-6f);
  EXPECT_NEAR(back(0, 1), 1, 1e-6f);
  EXPECT_NEAR(back(3, 3), 0.3f, 0.5f / 254);
}

TEST(GridMessages, RefusesABrokenTile) {
  MapTile message = toTile(cv::Mat1f(4, 4, 0.2f), 0, 0);
  message.png.resize(10);
  EXPECT_THROW(fromTile(message), InputError);
  message.png.clear();
  EXPECT_THROW(fromTile(message), InputError);
}

}  // namespace
}  // namespace cornerstone
