#include "cornerstone/ros/grid_messages.h"

#include <gtest/gtest.h>

#include <cmath>

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
  GridMap tile;
  tile.occupied = cv::Mat1f(4, 4, kUnseen);
  tile.occupied(0, 0) = 0.f;
  tile.occupied(0, 1) = 1.f;
  tile.occupied(3, 3) = 0.3f;
  tile.occupied(2, 0) = 0.5001f;
  const MapTile message = toTile(tile, {-8, 4});
  EXPECT_EQ(message.col, -8);
  EXPECT_EQ(message.size, 4);
  const cv::Mat1f back = cellsOf(message);
  EXPECT_EQ(back(1, 1), kUnseen);
  EXPECT_NE(back(2, 0), kUnseen);
  EXPECT_NEAR(back(0, 0), 0, 1e-6f);
  EXPECT_NEAR(back(0, 1), 1, 1e-6f);
  EXPECT_NEAR(back(3, 3), 0.3f, 0.5f / 254);
}

MapTile tileWithSurface() {
  GridMap tile;
  tile.occupied = cv::Mat1f(2, 2, 0.8f);
  tile.surface = {{1.234f, -5.678f, 400.f}, {-0.5f, 0.25f, 1e5f}};
  return toTile(tile, {0, 0});
}

TEST(GridMessages, TilesKeepTheirSurface) {
  const std::vector<SurfacePoint> back = surfaceOf(tileWithSurface());
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].x_m, 1.234f);
  EXPECT_EQ(back[0].y_m, -5.678f);
  EXPECT_EQ(back[1].weight, 1e5f);
}

TEST(GridMessages, RefusesABrokenTile) {
  MapTile message = tileWithSurface();
  message.png.resize(10);
  EXPECT_THROW(cellsOf(message), InputError);
  message.png.clear();
  EXPECT_THROW(cellsOf(message), InputError);
}

TEST(GridMessages, RefusesABrokenSurface) {
  MapTile message = tileWithSurface();
  message.surface.front().y = std::nanf("");
  EXPECT_THROW(surfaceOf(message), InputError);
  message = tileWithSurface();
  message.surface.front().weight = 0;
  EXPECT_THROW(surfaceOf(message), InputError);
  message = tileWithSurface();
  message.surface.resize(5, message.surface.front());
  EXPECT_THROW(surfaceOf(message), InputError) << "more points than cells";
}

}  // namespace
}  // namespace cornerstone
