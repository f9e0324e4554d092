// A robot that comes back to an old place after a way that drifted draws it there, or not at all.
#include "cornerstone/mapping/loop_closure.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "support/laser.h"

namespace cornerstone {
namespace {

void addBox(test::Room& room, const Eigen::Vector2d& at_m, const Eigen::Vector2d& size_m) {
  room.addRectangle(at_m.x(), at_m.y(), at_m.x() + size_m.x(), at_m.y() + size_m.y());
}

// A corridor of 2 m round a block of 40 m x 26 m, so long that no look sees both its ends, with cupboards
// where the robot starts.
test::Room ring() {
  test::Room room;
  room.addRectangle(0, 0, 44, 30);
  room.addRectangle(2, 2, 42, 28);
  addBox(room, {0, 1.8}, {0.6, 0.9});
  addBox(room, {1.5, 3.1}, {0.5, 0.7});
  addBox(room, {0, 4.6}, {0.5, 1.4});
  addBox(room, {1.6, 6.2}, {0.4, 0.5});
  addBox(room, {0, 7.5}, {0.3, 0.8});
  addBox(room, {3.2, 0}, {1.1, 0.5});
  addBox(room, {5.5, 1.5}, {0.6, 0.5});
  addBox(room, {7.1, 0}, {0.5, 0.6});
  return room;
}

struct Drive {
  const test::Room& room;
  Mapper& mapper;
  Pose2 truth, odom;

  Drive(const test::Room& in, const Pose2& start, Mapper& with) : room(in), mapper(with), truth(start) {}
  void go(const Pose2& step, const Pose2& as_counted) {
    truth = truth * step;
    odom = odom * as_counted;
    mapper.update(test::laserScan(room, truth), odom);
  }
  // slip: what the wheels count too much, as a share of the way.
  void ahead(double way_m, double slip = 0) {
    const int steps = static_cast<int>(std::ceil(way_m / 0.24));
    for (int i = 0; i < steps; ++i) go({way_m / steps, 0, 0}, {way_m / steps * (1 + slip), 0, 0});
  }
  void left(int quarters = 1) {
    const Pose2 turn{0, 0, 10 * M_PI / 180};
    for (int i = 0; i < 9 * quarters; ++i) go(turn, turn);
  }
  // All but the last side of a rectangle.
  void around(double length_m, double width_m, double slip) {
    left(4);  // to see all of where it starts
    ahead(length_m, slip);
    left();
    ahead(width_m);
    left();
    ahead(length_m);
    left();
  }
  double off_m(const Pose2& start) const {
    return (start.inverse() * truth.translation() - mapper.pose().map_from_base.translation()).norm();
  }
};

const Pose2 kStart{1, 1, 0};

// Once round the ring and a little on, with wheels that slip on the first side; how far the mapper is then
// from the truth.
double offAfterTheRing(const MapperParams& params) {
  const test::Room room = ring();
  Mapper mapper(params);
  Drive drive(room, kStart, mapper);
  drive.around(42, 28, 0.06);
  drive.ahead(28);
  drive.left();
  drive.ahead(16);
  return drive.off_m(kStart);
}

TEST(LoopClosure, ARobotThatComesBackIsFoundAtItsOldPlace) {
  MapperParams params = test::laserMapperParams();
  EXPECT_LT(offAfterTheRing(params), 0.3);
  params.loop.reach_m = 0;
  EXPECT_GT(offAfterTheRing(params), 0.8);
}

TEST(LoopClosure, WhatAsksTooMuchIsLeftOpen) {
  MapperParams params = test::laserMapperParams();
  params.loop.max_strain_sigmas = 1;
  EXPECT_GT(offAfterTheRing(params), 0.8);
}

// Two corridors with the same niches, side by side, and a long way round from the one into the other.
TEST(LoopClosure, PlacesThatLookAlikeStayTwo) {
  test::Room room;
  room.addRectangle(0, 0, 30, 14);
  room.addRectangle(2, 1.4, 28, 2.0);  // between the two corridors
  room.addRectangle(2, 3.4, 28, 12);
  for (const double y : {0.0, 2.0})
    for (const double x : {3.0, 5.5, 9.0, 13.0}) addBox(room, {x, y}, {0.5 + 0.1 * x, 0.3});
  Mapper mapper(test::laserMapperParams());
  Drive drive(room, kStart, mapper);
  drive.around(28, 12, 0);
  drive.ahead(10.3);
  drive.left();
  drive.ahead(12);
  EXPECT_LT(drive.off_m(kStart), 0.05);  // 2 m if the one were taken for the other
}

TEST(LoopClosure, WrongParametersAreNamed) {
  MapperParams params;
  params.loop.max_drift_ratio = 2;
  try {
    Mapper mapper(params);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("max_drift_ratio"), std::string::npos);
  }
}

}  // namespace
}  // namespace cornerstone
