// A robot whose wheels slipped, or that was pushed, is found again on its map, or not at all.
#include "cornerstone/mapping/relocalisation.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "support/laser.h"
#include "support/room_scan.h"

namespace cornerstone {
namespace {

constexpr double kDegree = M_PI / 180;

OccupancyGrid mapOf(const test::Room& room, const std::vector<Eigen::Vector2d>& places_m) {
  OccupancyGrid grid({});
  for (const Eigen::Vector2d& at : places_m)
    for (int turn = 0; turn < 12; ++turn) {
      const Pose2 pose{at.x(), at.y(), turn * 30 * kDegree};
      grid.insert(test::scanOf(room, pose), pose);
    }
  return grid;
}

void expectFound(const Relocalisation& found, const Pose2& truth) {
  ASSERT_TRUE(found.pose);
  const Pose2 error = truth.inverse() * found.pose->map_from_base;
  EXPECT_LT(error.translation().norm(), 0.05);
  EXPECT_LT(std::abs(error.yaw_rad), 1 * kDegree);
}

TEST(Relocalisation, FindsARobotThatWasPushed) {
  const test::Room room = test::officeRoom();
  const OccupancyGrid grid = mapOf(room, {{2, 2.5}, {4, 2.5}});
  const Pose2 truth{3, 2.4, 0.5};
  const Pose2 by_odometry = truth * Pose2{0.2, -0.15, 11 * kDegree};
  expectFound(relocalise({test::scanOf(room, truth), grid}, {by_odometry, 0.3, 15 * kDegree}, {}, {}), truth);
}

TEST(Relocalisation, FindsARobotThatWasTurnedByHand) {
  const test::Room room = test::officeRoom();
  const OccupancyGrid grid = mapOf(room, {{2, 2.5}, {4, 2.5}});
  const Pose2 truth{3, 2.4, 0.5};
  const Pose2 by_odometry = truth * Pose2{-0.6, 0.5, 160 * kDegree};
  expectFound(relocalise({test::scanOf(room, truth), grid}, {by_odometry, 1}, {}, {}), truth);
}

TEST(Relocalisation, RefusesARoomThatLooksTheSameAfterAQuarterTurn) {
  test::Room square;
  square.addRectangle(0, 0, 4, 4);
  const OccupancyGrid grid = mapOf(square, {{2, 2}});
  EXPECT_FALSE(relocalise({test::scanOf(square, {2, 2, 0.3}), grid}, {{2.1, 2, 0.6}, 1}, {}, {}).pose);
}

TEST(Relocalisation, RefusesAWorldThatIsNotTheMaps) {
  const OccupancyGrid grid = mapOf(test::officeRoom(), {{2, 2.5}, {4, 2.5}});
  test::Room other;
  other.addRectangle(0.8, 0.7, 4.9, 3.3);
  other.addRectangle(3.6, 1.2, 4.2, 1.9);
  EXPECT_FALSE(relocalise({test::scanOf(other, {2.5, 2.4, 0.3}), grid}, {{2.5, 2.4, 0.3}, 1}, {}, {}).pose);
}

TEST(Relocalisation, AnEmptyMapAndAnEmptyScanGiveNoAnswer) {
  const test::Room room = test::officeRoom();
  const RangeScan scan = test::scanOf(room, {3, 2.4, 0.5});
  EXPECT_FALSE(relocalise({scan, OccupancyGrid({})}, {{}, 1}, {}, {}).pose);
  EXPECT_FALSE(relocalise({{}, mapOf(room, {{3, 2.5}})}, {{}, 1}, {}, {}).pose);
}

TEST(Relocalisation, WrongParametersAreNamed) {
  MapperParams params;
  params.relocalisation.min_agreeing_share = 2;
  try {
    Mapper mapper(params);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("min_agreeing_share"), std::string::npos);
  }
}

// Looks around at two places, then somebody moves the robot, of which odometry knows nothing.
struct Moved {
  Pose2 error;  // of the pose at the end
  int slips = 0;
  double wrong_share = 0;  // of the occupied cells: farther than 0.15 m from every wall
};
RelocalisationParams on() {
  RelocalisationParams params;
  params.slip_reach_m = 0.3;
  params.reach_m = 1;
  return params;
}
Moved moveByHand(const Pose2& slip, const RelocalisationParams& relocalisation = on()) {
  const test::Room room = test::officeRoom();
  MapperParams params;
  params.relocalisation = relocalisation;
  Mapper mapper(params);
  const Pose2 start{2, 2.5, 0};
  Pose2 truth = start, odom;
  const auto look = [&](const Pose2& step, int times) {
    for (int i = 0; i < times; ++i) {
      truth = truth * step;
      odom = odom * step;
      mapper.update(test::laserScan(room, truth), odom);
    }
  };
  look({0, 0, 10 * kDegree}, 36);
  look({0.1, 0, 0}, 15);
  look({0, 0, 10 * kDegree}, 36);
  truth = truth * slip;
  look({0, 0, 1 * kDegree}, 15);
  const GridMap map = mapper.map();
  int occupied = 0, wrong = 0;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col)
      if (map.occupied(row, col) > 0.65F) {
        ++occupied;
        wrong += room.distanceTo(start * map.geometry.centreOf({col, row})) > 0.15;
      }
  return {(start.inverse() * truth).inverse() * mapper.pose().map_from_base, mapper.slips(),
          static_cast<double>(wrong) / occupied};
}

void expectFound(const Moved& moved) {
  EXPECT_GE(moved.slips, 1);
  EXPECT_LT(moved.error.translation().norm(), 0.05);
  EXPECT_LT(std::abs(moved.error.yaw_rad), 1 * kDegree);
  EXPECT_LT(moved.wrong_share, 0.01);
}

TEST(MapperSlips, AreFoundAndLeaveTheMapAsItIs) {
  for (const Pose2& slip : {Pose2{-0.2, 0.1, 8 * kDegree}, Pose2{0.15, 0, -12 * kDegree}}) {
    expectFound(moveByHand(slip));
    const Moved unsought = moveByHand(slip, {});
    EXPECT_EQ(unsought.slips, 0);
    EXPECT_GT(unsought.error.translation().norm(), 0.1);
  }
}

TEST(MapperSlips, ALaserIsFoundAtEveryHeading) {
  for (int turn_deg = -180; turn_deg < 180; turn_deg += 20) {
    SCOPED_TRACE(turn_deg);
    expectFound(moveByHand({0.3, 0.2, turn_deg * kDegree}));
  }
}

TEST(MapperSlips, AreNotSeenWhereThereAreNone) { EXPECT_EQ(moveByHand({}).slips, 0); }

// A hall that half a turn lays on itself, and in it two cupboards: one is moved to where half a turn would
// bring it, another comes. Turned by half a turn the look lies better on the map than as the robot stands.
int slipsInAHallThatChanged(const MapperParams& params) {
  test::Room before, after;
  for (test::Room* room : {&before, &after}) room->addRectangle(0, 0, 8, 6);
  before.addRectangle(0.5, 0.5, 1.8, 2.1);
  after.addRectangle(6.2, 3.9, 7.5, 5.5);
  after.addRectangle(5.6, 0.6, 6.4, 1.4);
  Mapper mapper(params);
  Pose2 odom{4, 3, 0};
  const auto look = [&](const test::Room& room, const Pose2& step, int times) {
    for (int i = 0; i < times; ++i) {
      odom = odom * step;
      mapper.update(test::laserScan(room, odom), odom);
    }
  };
  look(before, {0, 0, 10 * kDegree}, 36);
  look(after, {0, 0, 0.5 * kDegree}, 12);
  return mapper.slips();
}

TEST(MapperSlips, AHallThatLooksTheSameAfterHalfATurnDoesNotTurnTheRobot) {
  MapperParams params = test::laserMapperParams();
  EXPECT_EQ(slipsInAHallThatChanged(params), 0);
  params.relocalisation.min_agreeing_share_far = params.relocalisation.min_agreeing_share;
  EXPECT_GE(slipsInAHallThatChanged(params), 1);  // what the stricter share is for
}

}  // namespace
}  // namespace cornerstone
