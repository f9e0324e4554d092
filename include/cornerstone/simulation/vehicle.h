// A differential-drive robot on the floor and its odometry. World frame; v in m/s forward, w in rad/s
// counter-clockwise.
#pragma once

#include <cstdint>
#include <random>

#include "cornerstone/base/params.h"
#include "cornerstone/base/pose2.h"

namespace cornerstone {

struct Twist2 {
  double v_m_s = 0;
  double w_rad_s = 0;
};

struct VehicleParams {
  double radius_m = 0.2;       // of the circle that must not touch anything
  double height_m = 0.6;       // what hangs higher does not touch it
  double max_speed_m_s = 2.0;  // the paper's robots
  double max_turn_rate_rad_s = 2.0;
  double max_acceleration_m_s2 = 1.0;  // a wheeled office robot without slip
  double max_turn_acceleration_rad_s2 = 4.0;
  double command_timeout_s = 0.5;  // without a new command the robot brakes
};
void describe(ParamVisitor& visitor, VehicleParams& params);

class Vehicle {
 public:
  Vehicle(const VehicleParams& params, const Pose2& world_from_base);
  void command(const Twist2& twist, double time_s);
  // Accelerates towards the command, within limits, and moves along the arc; the motion in the base frame.
  Pose2 step(double time_s, double dt_s);
  void moveTo(const Pose2& world_from_base) { world_from_base_ = world_from_base; }
  void stop() { twist_ = {}; }
  const Pose2& worldFromBase() const { return world_from_base_; }
  const Twist2& twist() const { return twist_; }

 private:
  VehicleParams params_;
  Pose2 world_from_base_;
  Twist2 twist_, command_;
  double command_time_s_ = 0;
};

struct OdometryParams {
  double scale_error = 0.01;            // share of distance, systematic: a wheel's diameter
  double turn_scale_error = 0.01;       // share of angle turned, systematic: the wheel base
  double yaw_drift_rad_per_m = 0.0035;  // systematic, 0.2 degrees: unequal wheels
  double noise_m_per_sqrt_m = 0.005;    // random, grows with the root of the way
  double yaw_noise_rad_per_sqrt_m = 0.0035;
  double yaw_noise_per_sqrt_rad = 0.005;  // rad per root of the angle turned
};
void describe(ParamVisitor& visitor, OdometryParams& params);

// Dead reckoning with faults: each systematic error is drawn once, uniformly between -1 and 1 times its
// parameter.
class Odometry {
 public:
  Odometry(const OdometryParams& params, std::uint64_t seed);
  void move(const Pose2& base_from_next);
  const Pose2& odomFromBase() const { return odom_from_base_; }

 private:
  double normal() { return normal_(generator_); }

  OdometryParams params_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  double scale_, turn_scale_, yaw_drift_rad_per_m_;
  Pose2 odom_from_base_;
};

}  // namespace cornerstone
