#include "cornerstone/ros/tile_follower.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/grid_messages.h"

namespace cornerstone {
namespace {

MapTiles tilesAt(int col, float value, std::uint32_t epoch, std::uint32_t version) {
  MapTiles message;
  message.resolution = 0.1;
  message.map_epoch = epoch;
  message.version = version;
  GridMap tile;
  tile.occupied = cv::Mat1f(4, 4, value);
  tile.surface = {{0.1f * static_cast<float>(col), 0, 100}};
  message.tiles = {toTile(tile, {col, 0})};
  return message;
}

TEST(TileFollower, AddsTilesOfOneEpochAndDropsThoseOfAnOlderOne) {
  TileFollower follower;
  EXPECT_TRUE(follower.empty());
  EXPECT_TRUE(follower.map().occupied.empty());
  EXPECT_FALSE(follower.take(tilesAt(0, 0.2f, 1, 1)));
  EXPECT_FALSE(follower.take(tilesAt(4, 0.2f, 1, 2)));
  EXPECT_EQ(follower.map().geometry.cols, 8);
  EXPECT_EQ(follower.map().surface.size(), 2u);
  EXPECT_TRUE(follower.take(tilesAt(0, 0.2f, 2, 1))) << "another epoch";
  EXPECT_EQ(follower.map().geometry.cols, 4);
  EXPECT_EQ(follower.epoch(), 2u);
}

TEST(TileFollower, ACompleteMessageReplacesAll) {
  TileFollower follower;
  follower.take(tilesAt(4, 0.2f, 1, 1));
  MapTiles complete = tilesAt(0, 0.2f, 1, 2);
  complete.complete = true;
  EXPECT_FALSE(follower.take(complete));
  EXPECT_EQ(follower.map().geometry.cols, 4);
  EXPECT_NEAR(follower.map().geometry.origin_x_m, 0, 1e-12);
}

TEST(TileFollower, AMapThatIsResetIsEmptyAtOnce) {
  TileFollower follower;
  follower.take(tilesAt(0, 0.2f, 1, 1));
  MapTiles nothing;
  nothing.map_epoch = 2;
  nothing.complete = true;
  EXPECT_TRUE(follower.take(nothing)) << "the old frame must not live on until the robot sees something";
  EXPECT_TRUE(follower.empty());
  EXPECT_EQ(follower.epoch(), 2u);
  EXPECT_FALSE(follower.take(tilesAt(0, 0.2f, 2, 1)));
  EXPECT_FALSE(follower.empty());
}

TEST(TileFollower, KeepsTheNewestWay) {
  TileFollower follower;
  MapTiles message = tilesAt(0, 0.2f, 1, 1);
  for (const std::size_t places : {3u, 2u}) {
    message.way.resize(places);
    message.way.back().x = 1.5f;
    follower.take(message);
    ASSERT_EQ(follower.way().size(), places);
    EXPECT_EQ(follower.way().back(), Eigen::Vector2d(1.5, 0));
  }
}

TEST(TileFollower, AMessageAtFaultChangesNothing) {
  TileFollower follower;
  follower.take(tilesAt(0, 0.2f, 1, 1));
  MapTiles broken = tilesAt(4, 0.2f, 1, 2);
  broken.tiles.front().png.clear();
  EXPECT_THROW(follower.take(broken), InputError);
  MapTiles coarser = tilesAt(4, 0.2f, 1, 2);
  coarser.resolution = 0.2;
  EXPECT_THROW(follower.take(coarser), InputError);
  EXPECT_THROW(follower.take(MapTiles{}), InputError);
  MapTiles weightless = tilesAt(4, 0.2f, 1, 2);
  weightless.tiles.front().surface.front().weight = -1;
  EXPECT_THROW(follower.take(weightless), InputError);
  MapTiles astray = tilesAt(4, 0.2f, 1, 2);
  astray.way.resize(1);
  astray.way.front().y = std::nanf("");
  EXPECT_THROW(follower.take(astray), InputError);
  EXPECT_TRUE(follower.way().empty());
  EXPECT_EQ(follower.version(), 1u);
  EXPECT_EQ(follower.map().geometry.cols, 4);
}

}  // namespace
}  // namespace cornerstone
