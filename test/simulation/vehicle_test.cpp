#include "cornerstone/simulation/vehicle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cornerstone/base/errors.h"
#include "cornerstone/simulation/route_driver.h"

namespace cornerstone {
namespace {

TEST(Vehicle, AcceleratesWithinItsLimit) {
  Vehicle vehicle({}, {});
  vehicle.command({1, 0}, 0);
  for (int i = 0; i < 20; ++i) vehicle.step(0, 0.01);
  // 0.2 s at 1 m/s2: 0.2 m/s after 0.02 m.
  EXPECT_NEAR(vehicle.twist().v_m_s, 0.2, 1e-9);
  EXPECT_NEAR(vehicle.worldFromBase().x_m, 0.02, 1e-9);
}

TEST(Vehicle, DrivesAFullCircleBackToItsStart) {
  VehicleParams params;
  params.max_acceleration_m_s2 = params.max_turn_acceleration_rad_s2 = 1e12;
  Vehicle vehicle(params, {1, 2, 0});
  const int steps = 1000;
  vehicle.command({1, 1}, 0);
  vehicle.step(0, 1e-9);
  for (int i = 0; i < steps; ++i) vehicle.step(0, 2 * M_PI / steps);
  EXPECT_NEAR(vehicle.worldFromBase().x_m, 1, 1e-6);
  EXPECT_NEAR(vehicle.worldFromBase().y_m, 2, 1e-6);
}

TEST(Vehicle, BrakesWithoutCommands) {
  Vehicle vehicle({}, {});
  double time_s = 0;
  vehicle.command({0.3, 0}, time_s);
  for (int i = 0; i < 40; ++i) vehicle.step(time_s += 0.01, 0.01);
  EXPECT_NEAR(vehicle.twist().v_m_s, 0.3, 1e-9);
  for (int i = 0; i < 50; ++i) vehicle.step(time_s += 0.01, 0.01);
  EXPECT_NEAR(vehicle.twist().v_m_s, 0, 1e-9);
}

TEST(Odometry, WithoutFaultsItIsTheTruth) {
  Odometry odometry({0, 0, 0, 0, 0, 0}, 5);
  for (int i = 0; i < 4; ++i) odometry.move({1, 0, M_PI / 2});
  EXPECT_NEAR(odometry.odomFromBase().x_m, 0, 1e-9);
  EXPECT_NEAR(odometry.odomFromBase().y_m, 0, 1e-9);
}

TEST(Odometry, SystematicErrorsStayWithinTheirParameters) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Odometry odometry({0.02, 0, 0.01, 0, 0, 0}, seed);
    for (int i = 0; i < 1000; ++i) odometry.move({0.001, 0, 0});
    const Pose2 pose = odometry.odomFromBase();
    EXPECT_NEAR(pose.x_m, 1, 0.0201);
    EXPECT_GT(std::abs(pose.x_m - 1), 1e-6);
    EXPECT_LE(std::abs(pose.yaw_rad), 0.0101);
  }
}

TEST(Odometry, NoiseDoesNotDependOnTheStepLength) {
  // 1 m in 100 or in 1000 steps: the standard deviation of the length is 0.05 m both times.
  for (const int steps : {100, 1000}) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Odometry odometry({0, 0, 0, 0.05, 0, 0}, seed);
      for (int i = 0; i < steps; ++i) odometry.move({1.0 / steps, 0, 0});
      sum += std::pow(odometry.odomFromBase().x_m - 1, 2);
    }
    EXPECT_NEAR(std::sqrt(sum / 200), 0.05, 0.008) << steps;
  }
}

TEST(RouteDriver, ReachesItsPointsAndTurns) {
  ScenarioRobot robot;
  robot.speed_m_s = 1;
  robot.turn_rate_rad_s = 1;
  robot.route.resize(4);
  robot.route[0].to_m = Eigen::Vector2d(2, 0);
  robot.route[1].turn_rad = -2 * M_PI;
  robot.route[2].wait_s = 1;
  robot.route[3].to_m = Eigen::Vector2d(2, 2);
  const VehicleParams params;
  Vehicle vehicle(params, {});
  RouteDriver driver(robot, params);
  double time_s = 0, turned_rad = 0;
  while (!driver.done() && time_s < 60) {
    vehicle.command(driver.drive(vehicle.worldFromBase(), vehicle.twist(), time_s), time_s);
    turned_rad += vehicle.step(time_s, 0.02).yaw_rad;
    EXPECT_LE(vehicle.twist().v_m_s, 1 + 1e-9);
    EXPECT_LE(std::abs(vehicle.twist().w_rad_s), 1 + 1e-9);
    time_s += 0.02;
  }
  EXPECT_TRUE(driver.done());
  EXPECT_NEAR(vehicle.worldFromBase().x_m, 2, 0.1);
  EXPECT_NEAR(vehicle.worldFromBase().y_m, 2, 0.1);
  EXPECT_NEAR(turned_rad, -2 * M_PI + M_PI / 2, 0.1);
  // 2 m, 6.3 rad, 1 s, 1.6 rad, 2 m, each with its ramps.
  EXPECT_NEAR(time_s, 15, 3);
}

}  // namespace
}  // namespace cornerstone
