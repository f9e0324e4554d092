#include "cornerstone/mapping/tile_map.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

cv::Mat1f tileOf(float value) { return cv::Mat1f(4, 4, value); }

TEST(TileMap, AssemblesTilesOnBothSidesOfTheOrigin) {
  TileMap tiles(0.5, 4);
  EXPECT_TRUE(tiles.assemble().occupied.empty());
  tiles.put(-4, 0, tileOf(0.2f));
  tiles.put(4, 4, tileOf(0.9f));
  const GridMap map = tiles.assemble();
  EXPECT_EQ(map.geometry.cols, 12);
  EXPECT_EQ(map.geometry.rows, 8);
  EXPECT_NEAR(map.geometry.origin_x_m, -2, 1e-12);
  EXPECT_NEAR(map.geometry.origin_y_m, 0, 1e-12);
  EXPECT_NEAR(map.occupied(0, 3), 0.2f, 1e-6f);
  EXPECT_NEAR(map.occupied(7, 11), 0.9f, 1e-6f);
  EXPECT_EQ(map.occupied(0, 4), kUnseen);
}

TEST(TileMap, ANewerTileReplacesTheOlder) {
  TileMap tiles(0.5, 4);
  tiles.put(0, 0, tileOf(0.2f), {{0.1f, 0, 1}});
  tiles.put(0, 0, tileOf(0.7f), {{0.2f, 0, 1}});
  const GridMap map = tiles.assemble();
  EXPECT_NEAR(map.occupied(2, 2), 0.7f, 1e-6f);
  ASSERT_EQ(map.surface.size(), 1u);
  EXPECT_EQ(map.surface.front().x_m, 0.2f);
}

TEST(TileMap, RefusesWhatDoesNotFit) {
  EXPECT_THROW(TileMap(0, 4), InputError);
  TileMap tiles(0.5, 4);
  EXPECT_THROW(tiles.put(1, 0, tileOf(0.2f)), InputError);
  EXPECT_THROW(tiles.put(0, 0, cv::Mat1f(3, 4, 0.2f)), InputError);
  EXPECT_TRUE(tiles.assemble().occupied.empty());
}

TEST(TileMap, RefusesATileTooFarAwayToHold) {
  TileMap tiles(0.05, 4);
  tiles.put(0, 0, tileOf(0.2f));
  EXPECT_THROW(tiles.put(40000, 40000, tileOf(0.2f)), InputError);
  EXPECT_THROW(tiles.put(-2147483648, 2147483644, tileOf(0.2f)), InputError);
  EXPECT_EQ(tiles.assemble().geometry.cols, 4);
  tiles.put(0, 4000, tileOf(0.3f));
  EXPECT_EQ(tiles.assemble().geometry.rows, 4004);
}

}  // namespace
}  // namespace cornerstone
