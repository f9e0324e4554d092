#include "cornerstone/simulation/vehicle.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

double approach(double value, double target, double largest_step) {
  return value + std::clamp(target - value, -largest_step, largest_step);
}

}  // namespace

void describe(ParamVisitor& visitor, VehicleParams& params) {
  visitor.field("radius_m", params.radius_m);
  visitor.field("height_m", params.height_m);
  visitor.field("max_speed_m_s", params.max_speed_m_s);
  visitor.degrees("max_turn_rate_deg_s", params.max_turn_rate_rad_s);
  visitor.field("max_acceleration_m_s2", params.max_acceleration_m_s2);
  visitor.degrees("max_turn_acceleration_deg_s2", params.max_turn_acceleration_rad_s2);
  visitor.field("command_timeout_s", params.command_timeout_s);
}

void describe(ParamVisitor& visitor, OdometryParams& params) {
  visitor.field("scale_error", params.scale_error);
  visitor.field("turn_scale_error", params.turn_scale_error);
  visitor.degrees("yaw_drift_per_m_deg", params.yaw_drift_rad_per_m);
  visitor.field("noise_m_per_sqrt_m", params.noise_m_per_sqrt_m);
  visitor.degrees("yaw_noise_per_sqrt_m_deg", params.yaw_noise_rad_per_sqrt_m);
  visitor.field("yaw_noise_per_sqrt_rad", params.yaw_noise_per_sqrt_rad);
}

Vehicle::Vehicle(const VehicleParams& params, const Pose2& world_from_base)
    : params_(params), world_from_base_(world_from_base) {
  requirePositive(params.radius_m, "vehicle/radius_m");
  requirePositive(params.height_m, "vehicle/height_m");
  requirePositive(params.max_speed_m_s, "vehicle/max_speed_m_s");
  requirePositive(params.max_turn_rate_rad_s, "vehicle/max_turn_rate_deg_s");
  requirePositive(params.max_acceleration_m_s2, "vehicle/max_acceleration_m_s2");
  requirePositive(params.max_turn_acceleration_rad_s2, "vehicle/max_turn_acceleration_deg_s2");
  requirePositive(params.command_timeout_s, "vehicle/command_timeout_s");
}

void Vehicle::command(const Twist2& twist, double time_s) {
  command_.v_m_s = std::clamp(twist.v_m_s, -params_.max_speed_m_s, params_.max_speed_m_s);
  command_.w_rad_s = std::clamp(twist.w_rad_s, -params_.max_turn_rate_rad_s, params_.max_turn_rate_rad_s);
  command_time_s_ = time_s;
}

Pose2 Vehicle::step(double time_s, double dt_s) {
  if (time_s - command_time_s_ > params_.command_timeout_s) command_ = {};
  const Twist2 before = twist_;
  twist_.v_m_s = approach(twist_.v_m_s, command_.v_m_s, params_.max_acceleration_m_s2 * dt_s);
  twist_.w_rad_s = approach(twist_.w_rad_s, command_.w_rad_s, params_.max_turn_acceleration_rad_s2 * dt_s);
  const double way_m = (before.v_m_s + twist_.v_m_s) / 2 * dt_s;
  const double turn_rad = (before.w_rad_s + twist_.w_rad_s) / 2 * dt_s;
  // An arc, by its chord: exact to third order in a step's turn.
  const Pose2 base_from_next{way_m * std::cos(turn_rad / 2), way_m * std::sin(turn_rad / 2), turn_rad};
  world_from_base_ = world_from_base_ * base_from_next;
  return base_from_next;
}

Odometry::Odometry(const OdometryParams& params, std::uint64_t seed) : params_(params), generator_(seed) {
  requireWithin(params.scale_error, 0, 0.5, "odometry/scale_error");
  requireWithin(params.turn_scale_error, 0, 0.5, "odometry/turn_scale_error");
  requireWithin(params.yaw_drift_rad_per_m, 0, 1, "odometry/yaw_drift_per_m_deg");
  requireWithin(params.noise_m_per_sqrt_m, 0, 1, "odometry/noise_m_per_sqrt_m");
  requireWithin(params.yaw_noise_rad_per_sqrt_m, 0, 1, "odometry/yaw_noise_per_sqrt_m_deg");
  requireWithin(params.yaw_noise_per_sqrt_rad, 0, 1, "odometry/yaw_noise_per_sqrt_rad");
  std::uniform_real_distribution<double> sign(-1, 1);
  scale_ = 1 + sign(generator_) * params.scale_error;
  turn_scale_ = 1 + sign(generator_) * params.turn_scale_error;
  yaw_drift_rad_per_m_ = sign(generator_) * params.yaw_drift_rad_per_m;
}

void Odometry::move(const Pose2& base_from_next) {
  const double way_m = base_from_next.translation().norm(), turn_rad = std::abs(base_from_next.yaw_rad);
  // Always three draws, so that a robot's later errors do not depend on when it stood still.
  const double along = normal(), yaw_by_way = normal(), yaw_by_turn = normal();
  const double stretch = way_m > 0 ? scale_ + along * params_.noise_m_per_sqrt_m / std::sqrt(way_m) : 1;
  const double yaw_rad = base_from_next.yaw_rad * turn_scale_ + yaw_drift_rad_per_m_ * way_m +
                         yaw_by_way * params_.yaw_noise_rad_per_sqrt_m * std::sqrt(way_m) +
                         yaw_by_turn * params_.yaw_noise_per_sqrt_rad * std::sqrt(turn_rad);
  odom_from_base_ =
      odom_from_base_ * Pose2{base_from_next.x_m * stretch, base_from_next.y_m * stretch, yaw_rad};
}

}  // namespace cornerstone
