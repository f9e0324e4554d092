// Things that come, go and walk through, seen by a robot that stands or drives, through the whole mapper.
#include <gtest/gtest.h>

#include "cornerstone/mapping/mapper.h"
#include "support/room_scan.h"

namespace cornerstone {
namespace {

constexpr float kOccupied = 0.65F, kFree = 0.196F;

test::Room bareRoom() {
  test::Room room;
  room.addRectangle(0, 0, 6, 4);
  return room;
}

test::Room withBox(double x_m, double y_m, double half_m) {
  test::Room room = bareRoom();
  room.addRectangle(x_m - half_m, y_m - half_m, x_m + half_m, y_m + half_m);
  return room;
}

class Change : public ::testing::TestWithParam<double> {  // speed of the robot, m a look
 protected:
  Change()
      : mapper_([] {
          MapperParams params;
          params.graph.redraw_shift_m = 0;  // every solution draws the map anew
          return params;
        }()) {}
  void look(const test::Room& room) {
    const Pose2 pose = start_ * Pose2{GetParam() * looks_++, 0, 0};
    mapper_.update(test::scanOf(room, pose), start_.inverse() * pose);
  }
  // The largest probability within a square around a point of the room.
  float most(const Eigen::Vector2d& at_m, double half_m) const {
    const GridMap map = mapper_.map();
    float most = 0;
    for (double dx = -half_m; dx <= half_m; dx += 0.05)
      for (double dy = -half_m; dy <= half_m; dy += 0.05) {
        const Cell cell =
            map.geometry.cellAt(start_.inverse() * Eigen::Vector2d(at_m + Eigen::Vector2d(dx, dy)));
        if (map.geometry.contains(cell)) most = std::max(most, map.occupied(cell.row, cell.col));
      }
    return most;
  }

  Pose2 start_{0.6, 2, 0};
  Mapper mapper_;
  int looks_ = 0;
};

// At 10 looks a second: standing, 0.2 m/s, 0.5 m/s.
INSTANTIATE_TEST_SUITE_P(Speeds, Change, ::testing::Values(0.0, 0.02, 0.05));

TEST_P(Change, ANewObstacleIsThereWithinTwoLooks) {
  for (int i = 0; i < 8; ++i) look(bareRoom());
  EXPECT_LT(most({3, 2}, 0.1), kFree);
  for (int i = 0; i < 2; ++i) look(withBox(3, 2, 0.2));
  EXPECT_GT(most({2.8, 2}, 0.05), kOccupied);
}

TEST_P(Change, WhatGoesIsFreeWithinTenLooks) {
  for (int i = 0; i < 6; ++i) look(withBox(3, 2, 0.2));
  EXPECT_GT(most({2.8, 2}, 0.05), kOccupied);
  for (int i = 0; i < 10; ++i) look(bareRoom());
  EXPECT_LT(most({3, 2}, 0.3), kFree);
}

// A door in the wall x = 3 between two halves of the room.
TEST_P(Change, ADoorThatOpensIsFreeWithinTenLooks) {
  test::Room open = bareRoom();
  open.walls.push_back({{3, 0}, {3, 1.5}});
  open.walls.push_back({{3, 2.5}, {3, 4}});
  test::Room closed = open;
  closed.walls.push_back({{3, 1.5}, {3, 2.5}});
  for (int i = 0; i < 7; ++i) look(closed);
  EXPECT_GT(most({3, 2}, 0.05), kOccupied);
  for (int i = 0; i < 10; ++i) look(open);
  EXPECT_LT(most({3, 2}, 0.3), kFree);
  EXPECT_GT(most({3, 1.3}, 0.05), kOccupied);  // the wall beside it stays
}

// Somebody of 0.4 m crosses the view at 1 m/s.
TEST_P(Change, WhoWalksThroughLeavesNoTrail) {
  for (int i = 0; i < 3; ++i) look(bareRoom());
  for (int i = 0; i < 40; ++i) look(withBox(4, 0.3 + 0.085 * i, 0.2));
  for (int i = 0; i < 10; ++i) look(bareRoom());
  // What left the view while somebody stood there stays as it was seen last; the rest must be free.
  const double view_m = 3.75 - (start_.x_m + GetParam() * looks_);
  for (double y_m = 0.5; y_m <= 3.5; y_m += 0.25)
    if (std::abs(y_m - 2) + 0.25 < view_m) {
      EXPECT_LE(most({4, y_m}, 0.25), 0.5F) << y_m;
    }
}

// What came and went while nothing else moved stays so in the map that is drawn anew from the looks kept.
TEST_P(Change, HoldsWhenTheMapIsDrawnAnew) {
  if (GetParam() > 0.02) GTEST_SKIP() << "the room is too short to drive on";
  for (int i = 0; i < 8; ++i) look(withBox(4, 2, 0.2));
  for (int i = 0; i < 12; ++i) look(withBox(2.6, 3.2, 0.2));
  // Turns on the spot, and back.
  const Pose2 at = start_ * Pose2{GetParam() * looks_, 0, 0};
  for (int i = 0; i < 120; ++i) {
    const Pose2 pose = at * Pose2{0, 0, 2 * M_PI / 120 * i};
    mapper_.update(test::scanOf(withBox(2.6, 3.2, 0.2), pose), start_.inverse() * pose);
  }
  ASSERT_GE(mapper_.redraws(), 1);
  EXPECT_LT(most({4, 2}, 0.3), kOccupied);
  EXPECT_GT(most({2.4, 3.1}, 0.1), kOccupied);
}

}  // namespace
}  // namespace cornerstone
