#include "cornerstone/landmarks/landmark_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "cornerstone/mapping/occupancy_grid.h"
#include "support/drawn_maps.h"
#include "support/room_scan.h"

namespace cornerstone {
namespace {

// The office as far as a robot has come.
GridMap seenUpTo(double x_m) {
  DrawnView view{Pose2{0, 0, 0.3}};
  GridMap all = draw(drawnOffice(), view);
  for (int row = 0; row < all.geometry.rows; ++row)
    for (int col = 0; col < all.geometry.cols; ++col)
      if ((view.world_from_map * all.geometry.centreOf({col, row})).x() > x_m)
        all.occupied(row, col) = kUnseen;
  return all;
}

GridMap without(const GridMap& map, int cols, int rows) {  // less of the map's low end
  GridMap part = map;
  part.geometry.origin_x_m += cols * map.geometry.resolution_m;
  part.geometry.origin_y_m += rows * map.geometry.resolution_m;
  part.geometry.cols -= cols;
  part.geometry.rows -= rows;
  part.occupied = map.occupied(cv::Rect(cols, rows, part.geometry.cols, part.geometry.rows)).clone();
  return part;
}

// Corners of one list that the other lacks. Of two guesses that are alike to the last digit another one may
// win, so that a corner may be another one of the same wall's ends.
std::size_t countMissing(const Landmarks& one, const Landmarks& other) {
  return static_cast<std::size_t>(
      std::count_if(one.corners.begin(), one.corners.end(), [&](const CornerLandmark& a) {
        return std::none_of(other.corners.begin(), other.corners.end(), [&](const CornerLandmark& b) {
          return a.kind == b.kind && (a.pose.translation() - b.pose.translation()).norm() < 0.01;
        });
      }));
}

void expectSameCorners(const Landmarks& one, const Landmarks& other) {
  EXPECT_LE(countMissing(one, other), 2u);
  EXPECT_LE(countMissing(other, one), 2u);
}

TEST(LandmarkFollower, FindsWhatAWholeSearchFinds) {
  LandmarkFollower follower({});
  for (double x_m = 2; x_m < 18; x_m += 1) {
    const GridMap map = seenUpTo(x_m);
    const Landmarks& followed = follower.update(map, x_m);
    const Landmarks whole = detectLandmarks(map, {});
    expectSameCorners(followed, whole);
    EXPECT_EQ(followed.edges.size(), whole.edges.size()) << x_m;
    EXPECT_EQ(cv::countNonZero(followed.states != whole.states), 0);
  }
}

// A robot turns in a room: its surface, too, is that of the newest map.
TEST(LandmarkFollower, FindsWhatAWholeSearchFindsOnTheSurface) {
  test::Room room;
  room.addRectangle(0, 0, 4, 3);
  OccupancyGrid grid({});
  LandmarkFollower follower({});
  for (int look = 0; look < 40; ++look) {
    const Pose2 at{1.8 + 0.01 * look, 1.5, look * 9 * M_PI / 180};
    grid.insert(test::scanOf(room, at), at);
    const GridMap map = grid.snapshot();
    const Landmarks& followed = follower.update(map, look);
    if (look % 8 == 7) expectSameCorners(followed, detectLandmarks(map, {}));
  }
  ASSERT_EQ(follower.landmarks().corners.size(), 4u);
  for (const CornerLandmark& corner : follower.landmarks().corners)
    EXPECT_LT(room.distanceTo(corner.pose.translation()), 0.005);
}

TEST(LandmarkFollower, LooksOnlyWhereTheMapChanged) {
  LandmarkFollower follower({});
  GridMap map = seenUpTo(20);
  follower.update(map, 0);
  EXPECT_EQ(follower.searchedShare(), 1);
  follower.update(map, 1);
  EXPECT_EQ(follower.searchedShare(), 0);
  map.occupied = map.occupied.clone();
  map.occupied(map.geometry.rows / 2, map.geometry.cols / 2) = 0.9f;
  follower.update(map, 2);
  EXPECT_GT(follower.searchedShare(), 0);
  EXPECT_LT(follower.searchedShare(), 0.2);
}

TEST(LandmarkFollower, CornersKeepTheirIdentityAndVanishWithTheirWalls) {
  LandmarkFollower follower({});
  const Landmarks first = follower.update(seenUpTo(8), 1);
  ASSERT_GT(first.corners.size(), 5u);
  const Landmarks second = follower.update(seenUpTo(20), 2);
  std::set<std::uint32_t> ids;
  for (const CornerLandmark& corner : second.corners)
    EXPECT_TRUE(ids.insert(corner.id).second) << "one id twice";
  std::size_t kept = 0;
  for (const CornerLandmark& corner : first.corners) {
    EXPECT_NE(corner.id, 0u);
    for (const CornerLandmark& later : second.corners)
      if (later.id == corner.id) {
        EXPECT_LT((later.pose.translation() - corner.pose.translation()).norm(), 0.25);
        EXPECT_EQ(later.since_s, 1);
        EXPECT_GE(later.looks, corner.looks);
        ++kept;
      }
  }
  EXPECT_GE(kept + 2, first.corners.size()) << "all but those at the edge of what was seen";
  GridMap gone = seenUpTo(20);
  gone.occupied.setTo(kUnseen);
  EXPECT_TRUE(follower.update(gone, 3).corners.empty());
}

TEST(LandmarkFollower, AGrowingGridIsTheSameMap) {
  LandmarkFollower follower({});
  const GridMap whole = seenUpTo(20);
  follower.update(without(whole, 40, 32), 0);
  const Landmarks& followed = follower.update(whole, 1);
  EXPECT_LT(follower.searchedShare(), 1.01);
  expectSameCorners(followed, detectLandmarks(whole, {}));
  const GridMap less = without(whole, 100, 8);
  for (const CornerLandmark& corner : follower.update(less, 2).corners)
    EXPECT_TRUE(less.geometry.contains(less.geometry.cellAt(corner.pose.translation())));
}

TEST(LandmarkFollower, EmptyMapsAndOtherResolutionsAreNoTrouble) {
  LandmarkFollower follower({});
  EXPECT_TRUE(follower.update(GridMap{}, 0).corners.empty());
  EXPECT_FALSE(follower.update(seenUpTo(20), 1).corners.empty());
  DrawnView coarse{Pose2{}};
  coarse.resolution_m = 0.07;
  const GridMap other = draw(drawnOffice(), coarse);
  expectSameCorners(follower.update(other, 2), detectLandmarks(other, {}));
  EXPECT_TRUE(follower.update(GridMap{}, 3).corners.empty());
}

}  // namespace
}  // namespace cornerstone
