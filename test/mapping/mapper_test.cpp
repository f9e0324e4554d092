#include "cornerstone/mapping/mapper.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "cornerstone/scan/column_scan.h"
#include "support/room.h"
#include "support/room_scan.h"
#include "support/tour.h"

namespace cornerstone {
namespace {

RangeScan lookFrom(const test::Room& room, const Pose2& pose, std::mt19937& random) {
  return scanFromDisparity(disparityOf(room, pose, test::rigOf(160), {}, random), test::levelCamera(), {});
}

double distanceToWay(const Mapper& mapper, const Eigen::Vector2d& place_m) {
  double nearest_m = 1e9;
  for (const Eigen::Vector2d& at : mapper.way()) nearest_m = std::min(nearest_m, (at - place_m).norm());
  return nearest_m;
}

// 48 m through officeRoom() with 3 % and 2 degrees a metre of drift: without correction the end is metres
// off.
TEST(Mapper, TakesMostOfTheDriftOutOfATour) {
  const test::Room room = test::officeRoom();
  std::mt19937 random(1);
  const auto steps = test::driveTour(test::officeTour(), {}, random);
  MapperParams params;
  params.odometry.scale_ratio = 0.03;  // of a robot whose odometry is known to be bad
  params.odometry.yaw_drift_rad_per_m = 0.035;
  Mapper mapper(params);
  const Pose2 start = steps.front().map_from_base;
  Pose2 error, by_odometry;
  double worst_m = 0, worst_by_odometry_m = 0;
  for (const auto& step : steps) {
    mapper.update(lookFrom(room, step.map_from_base, random), step.odom_from_base);
    const Pose2 truth = start.inverse() * step.map_from_base;
    error = truth.inverse() * mapper.pose().map_from_base;
    by_odometry = truth.inverse() * step.odom_from_base;
    worst_m = std::max(worst_m, error.translation().norm());
    worst_by_odometry_m = std::max(worst_by_odometry_m, by_odometry.translation().norm());
  }
  EXPECT_GT(worst_by_odometry_m, 1.5);
  EXPECT_LT(worst_m, worst_by_odometry_m / 4);
  EXPECT_LT(std::abs(error.yaw_rad), 0.1);
  const Pose2 same = mapper.mapFromOdom() * steps.back().odom_from_base;
  EXPECT_NEAR(same.x_m, mapper.pose().map_from_base.x_m, 1e-9);
  for (const auto& step : steps) {  // within a square and the distance between two frames, and the drift
    const Pose2 truth = start.inverse() * step.map_from_base;
    EXPECT_LT(distanceToWay(mapper, truth.translation()), 0.55 + worst_m);
  }
}

// A box that went while the robot stood must not come back when the map is drawn anew, and the tiles that
// others follow must all be told.
TEST(Mapper, ARedrawnMapKeepsWhatChanged) {
  test::Room with_box = test::officeRoom(), without = with_box;
  with_box.addRectangle(3.4, 2.4, 3.7, 2.7);
  MapperParams params;
  params.graph.redraw_shift_m = 0;  // every solution draws the map anew
  Mapper mapper(params);
  const Pose2 first{2, 2.5, 0};
  const auto look = [&](const test::Room& room, const Pose2& pose) {
    mapper.update(test::scanOf(room, pose), first.inverse() * pose);
  };
  const auto boxIsThere = [&] {
    const GridMap map = mapper.grid().snapshot();
    const Cell front = map.geometry.cellAt({3.42 - first.x_m, 2.55 - first.y_m});
    return map.occupied(front.row, front.col) > 0.65F || map.occupied(front.row, front.col - 1) > 0.65F;
  };
  for (int i = 0; i < 6; ++i) look(with_box, first);
  EXPECT_TRUE(boxIsThere());
  for (int i = 0; i < 25; ++i) look(without, first);
  EXPECT_FALSE(boxIsThere());
  const auto version = mapper.grid().version();
  for (int i = 1; i < 90; ++i) look(without, {2, 2.5, 0.05 * i});
  ASSERT_GE(mapper.redraws(), 1);
  EXPECT_FALSE(boxIsThere());
  EXPECT_EQ(mapper.grid().changedTiles(version).size(), mapper.grid().changedTiles(0).size());
}

// With the true poses the map must be sharp: what is wrong then is the sensor model's fault.
TEST(Mapper, TruePosesGiveASharpMap) {
  const test::Room room = test::officeRoom();
  std::mt19937 random(2);
  test::TourParams exact;
  exact.scale_error = exact.yaw_drift_rad_per_m = exact.noise_m_per_sqrt_m = exact.noise_rad_per_sqrt_m = 0;
  const auto steps = test::driveTour(test::officeTour(), exact, random);
  MapperParams params;
  params.fit_scans = false;
  Mapper mapper(params);
  for (const auto& step : steps)
    mapper.update(lookFrom(room, step.map_from_base, random), step.odom_from_base);
  for (const auto& step : steps) EXPECT_LT(distanceToWay(mapper, step.odom_from_base.translation()), 0.5);
  const GridMap map = mapper.grid().snapshot();
  int occupied = 0, good = 0;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      if (map.occupied(row, col) <= 0.65F) continue;
      ++occupied;
      good += room.distanceTo(steps.front().map_from_base * map.geometry.centreOf({col, row})) <= 0.1;
    }
  EXPECT_GT(occupied, 800);
  EXPECT_GT(good, 0.9 * occupied);
}

TEST(Mapper, RefusesPosesThatAreNotNumbersAndStaysAsItWas) {
  const test::Room room = test::officeRoom();
  std::mt19937 random(3);
  Mapper mapper({});
  const RangeScan scan = lookFrom(room, {3, 2, 0}, random);
  mapper.update(scan, {});
  const auto version = mapper.grid().version();
  EXPECT_THROW(mapper.update(scan, {NAN, 0, 0}), InputError);
  EXPECT_EQ(mapper.grid().version(), version);
}

TEST(Mapper, EmptyScansAreNotInsertedButThePoseGoesOn) {
  Mapper mapper({});
  mapper.update({}, {});
  const MapperUpdate update = mapper.update({}, {1, 0, 0});
  EXPECT_FALSE(update.inserted);
  EXPECT_FALSE(update.fitted);
  EXPECT_NEAR(mapper.pose().map_from_base.x_m, 1, 1e-9);
  EXPECT_NEAR(std::sqrt(update.covariance(0, 0)), 0.0078, 0.001);  // 0.5 % of scale and 6 mm of noise
}

TEST(Mapper, ResetBeginsANewEpochAndLoadGoesOnInASavedMap) {
  const test::Room room = test::officeRoom();
  std::mt19937 random(4);
  Mapper mapper({});
  const Pose2 at{3, 2, 0.5};
  for (int i = 0; i < 5; ++i) mapper.update(lookFrom(room, at, random), at);
  const GridMap saved = mapper.grid().snapshot();
  const auto epoch = mapper.epoch();
  mapper.reset();
  EXPECT_TRUE(mapper.grid().empty());
  EXPECT_GT(mapper.epoch(), epoch);
  EXPECT_TRUE(mapper.way().empty());
  mapper.load({saved}, at);
  EXPECT_EQ(mapper.grid().snapshot().occupied.size(), saved.occupied.size());
  mapper.update(lookFrom(room, at, random), {7, -4, 2});  // odometry starts anywhere
  EXPECT_NEAR(mapper.pose().map_from_base.x_m, at.x_m, 0.05);
  EXPECT_NEAR(mapper.pose().map_from_base.yaw_rad, at.yaw_rad, 0.03);
  EXPECT_EQ(mapper.way().size(), 1u);
}

TEST(OdometryFilter, LearnsADriftFromPoses) {
  OdometryFilter filter({});
  filter.place({{}, Eigen::Matrix3d::Identity() * 1e-6});
  Pose2 truth;
  for (int i = 0; i < 200; ++i) {
    truth = truth * Pose2{0.1, 0, 0.02};
    filter.step(
        {0.1 / 0.97, 0, 0.02 + 0.003});  // 3 % too long, 0.03 rad/m of drift (of the odometer's metres)
    const Eigen::Matrix3d covariance =
        (filter.pose().covariance.inverse() + Eigen::Matrix3d::Identity() * 1e4).inverse();
    filter.correct({truth, covariance});
  }
  EXPECT_NEAR(filter.rates()(0), 0.03, 0.006);
  EXPECT_NEAR(filter.rates()(1) * 0.1 / 0.97 + filter.rates()(2) * 0.023, 0.003, 5e-4);
}

}  // namespace
}  // namespace cornerstone
