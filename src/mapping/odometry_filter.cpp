#include "cornerstone/mapping/odometry_filter.h"

#include <Eigen/LU>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// A robot that stands is known to stand, but for a twentieth of a millimetre and a hundredth of a degree a
// scan.
constexpr double kStill_m = 5e-5, kStill_rad = 2e-4;

Eigen::Vector3d rateSigmas(const OdometryNoise& noise) {
  return {noise.scale_ratio, noise.yaw_drift_rad_per_m, noise.turn_scale_ratio};
}

double square(double value) { return value * value; }

}  // namespace

void describe(ParamVisitor& visitor, OdometryNoise& noise) {
  visitor.field("scale_ratio", noise.scale_ratio);
  visitor.field("yaw_drift_rad_per_m", noise.yaw_drift_rad_per_m);
  visitor.field("turn_scale_ratio", noise.turn_scale_ratio);
  visitor.field("drift_change_per_sqrt_m", noise.drift_change_per_sqrt_m);
  visitor.field("noise_m_per_sqrt_m", noise.noise_m_per_sqrt_m);
  visitor.field("noise_rad_per_sqrt_m", noise.noise_rad_per_sqrt_m);
  visitor.field("noise_rad_per_sqrt_rad", noise.noise_rad_per_sqrt_rad);
}

void requireValid(const OdometryNoise& noise) {
  requireWithin(noise.scale_ratio, 1e-6, 1, "scale_ratio");
  requireWithin(noise.yaw_drift_rad_per_m, 1e-6, 3, "yaw_drift_rad_per_m");
  requireWithin(noise.turn_scale_ratio, 1e-6, 1, "turn_scale_ratio");
  requireWithin(noise.drift_change_per_sqrt_m, 0, 10, "drift_change_per_sqrt_m");
  requireWithin(noise.noise_m_per_sqrt_m, 1e-5, 1, "noise_m_per_sqrt_m");
  requireWithin(noise.noise_rad_per_sqrt_m, 1e-5, 3, "noise_rad_per_sqrt_m");
  requireWithin(noise.noise_rad_per_sqrt_rad, 1e-5, 1, "noise_rad_per_sqrt_rad");
}

OdometryFilter::OdometryFilter(const OdometryNoise& noise) : noise_(noise) {
  requireValid(noise);
  covariance_.bottomRightCorner<3, 3>() = rateSigmas(noise).cwiseAbs2().asDiagonal();
}

void OdometryFilter::place(const PoseEstimate& estimate) {
  map_from_base_ = estimate.map_from_base;
  covariance_.topLeftCorner<3, 3>() = estimate.covariance;
  covariance_.topRightCorner<3, 3>().setZero();
  covariance_.bottomLeftCorner<3, 3>().setZero();
}

void OdometryFilter::step(const Pose2& odom_step) {
  const double dx = odom_step.x_m, dy = odom_step.y_m, turn = odom_step.yaw_rad;
  // Heading is lost evenly along the step: its direction is off by half of what is lost.
  const double drift_rad = rates_(1) * dx + rates_(2) * turn;
  const Eigen::Vector2d way =
      (1 - rates_(0)) * (Pose2{0, 0, -0.5 * drift_rad}.rotation() * Eigen::Vector2d(dx, dy));
  const Pose2 step{way.x(), way.y(), turn - drift_rad};
  const Eigen::Matrix2d rotation = map_from_base_.rotation();
  const Eigen::Vector2d moved = rotation * step.translation();

  Matrix6d by_state = Matrix6d::Identity();
  by_state(0, 2) = -moved.y();
  by_state(1, 2) = moved.x();
  by_state.block<2, 1>(0, 3) = -(rotation * Eigen::Vector2d(dx, dy));
  by_state(2, 4) = -dx;
  by_state(2, 5) = -turn;

  const double way_m = std::hypot(dx, dy);
  const double place_m2 = square(noise_.noise_m_per_sqrt_m) * way_m + square(kStill_m);
  const double yaw_rad2 = square(noise_.noise_rad_per_sqrt_m) * way_m +
                          square(noise_.noise_rad_per_sqrt_rad) * std::abs(turn) + square(kStill_rad);
  covariance_ = by_state * covariance_ * by_state.transpose();
  covariance_.diagonal().head<3>() += Eigen::Vector3d(place_m2, place_m2, yaw_rad2);
  const double change = square(noise_.drift_change_per_sqrt_m) * way_m;
  covariance_.diagonal().tail<3>() += change * rateSigmas(noise_).cwiseAbs2();
  map_from_base_ = map_from_base_ * step;
}

void OdometryFilter::moveBy(const Pose2& correction, const Eigen::Vector3d& rates) {
  Matrix6d turn = Matrix6d::Identity();
  turn.topLeftCorner<2, 2>() = correction.rotation();
  covariance_ = turn * covariance_ * turn.transpose();
  map_from_base_ = correction * map_from_base_;
  rates_ = rates;
}

// Conditioning of a joint Gaussian on a new marginal of its pose.
void OdometryFilter::correct(const PoseEstimate& posterior) {
  const Eigen::Matrix3d prior = covariance_.topLeftCorner<3, 3>();
  const Eigen::Matrix3d gain = covariance_.bottomLeftCorner<3, 3>() * prior.inverse();
  const Pose2& to = posterior.map_from_base;
  const Eigen::Vector3d moved(to.x_m - map_from_base_.x_m, to.y_m - map_from_base_.y_m,
                              wrapAngle(to.yaw_rad - map_from_base_.yaw_rad));
  rates_ += gain * moved;
  const Eigen::Matrix3d cross = gain * posterior.covariance;
  covariance_.bottomRightCorner<3, 3>() -= gain * (prior - posterior.covariance) * gain.transpose();
  covariance_.topLeftCorner<3, 3>() = posterior.covariance;
  covariance_.bottomLeftCorner<3, 3>() = cross;
  covariance_.topRightCorner<3, 3>() = cross.transpose();
  map_from_base_ = to;
}

}  // namespace cornerstone
