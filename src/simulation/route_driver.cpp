#include "cornerstone/simulation/route_driver.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

constexpr double kArrived_m = 0.05;
constexpr double kArrived_rad = 0.02;
constexpr double kAligned_rad = 0.1;  // good enough to set off: the rest is steered out on the way
constexpr double kAstray_rad = 0.6;   // turn on the spot again
constexpr double kSteering_per_s = 2.0;
constexpr double kBrakingShare = 0.7;  // of the limit, so that a sampled controller does not overshoot

double brakingSpeed(double acceleration, double way) {
  return std::sqrt(2 * kBrakingShare * acceleration * way);
}

}  // namespace

RouteDriver::RouteDriver(const ScenarioRobot& robot, const VehicleParams& vehicle)
    : robot_(robot), vehicle_(vehicle) {}

void RouteDriver::next() {
  ++step_;
  aligned_ = started_ = false;
  turned_rad_ = 0;
}

double RouteDriver::turnRateFor(double remaining_rad) const {
  const double limit = std::min({robot_.turn_rate_rad_s, vehicle_.max_turn_rate_rad_s,
                                 brakingSpeed(vehicle_.max_turn_acceleration_rad_s2, std::abs(remaining_rad)),
                                 std::abs(remaining_rad) * 2 * kSteering_per_s});
  return std::copysign(limit, remaining_rad);
}

Twist2 RouteDriver::driveTo(const Eigen::Vector2d& to_m, const Pose2& world_from_base) {
  const Eigen::Vector2d way_m = to_m - world_from_base.translation();
  const double distance_m = way_m.norm();
  const double bearing = wrapAngle(std::atan2(way_m.y(), way_m.x()) - world_from_base.yaw_rad);
  // Close by, the bearing says little: past the point is there, too.
  if (distance_m < kArrived_m || (aligned_ && distance_m < 4 * kArrived_m && std::cos(bearing) < 0)) {
    next();
    return {};
  }
  if (std::abs(bearing) < kAligned_rad) aligned_ = true;
  if (std::abs(bearing) > kAstray_rad) aligned_ = false;
  if (!aligned_) return {0, turnRateFor(bearing)};
  const double speed = std::min(
      {robot_.speed_m_s, vehicle_.max_speed_m_s, brakingSpeed(vehicle_.max_acceleration_m_s2, distance_m)});
  return {std::max(speed, 0.05),
          std::clamp(kSteering_per_s * bearing, -robot_.turn_rate_rad_s, robot_.turn_rate_rad_s)};
}

Twist2 RouteDriver::turn(double turn_rad, const Pose2& world_from_base, const Twist2& twist) {
  if (!started_) {
    started_ = true;
    last_yaw_rad_ = world_from_base.yaw_rad;
  }
  turned_rad_ += wrapAngle(world_from_base.yaw_rad - last_yaw_rad_);
  last_yaw_rad_ = world_from_base.yaw_rad;
  const double remaining_rad = turn_rad - turned_rad_;
  if (std::abs(remaining_rad) < kArrived_rad && std::abs(twist.w_rad_s) < 0.2) {
    next();
    return {};
  }
  return {0, turnRateFor(remaining_rad)};
}

Twist2 RouteDriver::drive(const Pose2& world_from_base, const Twist2& twist, double time_s) {
  if (done()) return {};
  const RouteStep& step = robot_.route[step_];
  if (step.to_m) return driveTo(*step.to_m, world_from_base);
  if (step.turn_rad) return turn(*step.turn_rad, world_from_base, twist);
  if (!started_) {
    started_ = true;
    wait_until_s_ = time_s + *step.wait_s;
  }
  if (time_s >= wait_until_s_) next();
  return {};
}

}  // namespace cornerstone
