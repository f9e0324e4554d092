// Carries a pose by odometry and learns how that odometry drifts.
//
// Most of what odometry gets wrong is systematic (a wheel too small, axles not square), so the filter's state
// is the pose with three rates, each a Gaussian:  s (scale), b (yaw per metre), t (scale of turns). For a
// step (dx, dy, dyaw)
//   true step = (dx (1 - s), dy (1 - s), dyaw - b dx - t dyaw) + noise that grows with the root of the way.
// A pose from outside (scan_fit.h) then corrects the rates through their covariance with the pose. Without
// the rates the pose would lag behind a steady drift by the same amount for ever, and the map with it.
#pragma once

#include "cornerstone/base/params.h"
#include "cornerstone/base/pose2.h"

namespace cornerstone {

struct OdometryNoise {
  // What is not known about the systematic drift at the start (standard deviations).
  double scale_ratio = 0.005;          // wheels that were measured; more for tracks and worn tyres
  double yaw_drift_rad_per_m = 0.015;  // nearly a degree a metre
  double turn_scale_ratio = 0.02;
  // How fast the rates themselves change with load and floor, relative to the above, per root of a metre.
  double drift_change_per_sqrt_m = 0.05;
  // What is left: noise. It adds up with the root of the way.
  double noise_m_per_sqrt_m = 0.006;
  double noise_rad_per_sqrt_m = 0.004;
  double noise_rad_per_sqrt_rad = 0.006;
};
void describe(ParamVisitor& visitor, OdometryNoise& noise);
void requireValid(const OdometryNoise& noise);  // throws InputError naming the parameter

struct PoseEstimate {
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // x, y, yaw in the map frame; m and rad
};

class OdometryFilter {
 public:
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  explicit OdometryFilter(const OdometryNoise& noise);
  // Sets the pose; what was learned of the drift stays.
  void place(const PoseEstimate& estimate);
  void step(const Pose2& odom_step);  // of the base, in its own frame before the step
  void correct(const PoseEstimate& posterior);
  // The map was drawn anew: the pose moves with it, its uncertainty stays; rates: of the graph that knows.
  void moveBy(const Pose2& correction, const Eigen::Vector3d& rates);
  PoseEstimate pose() const { return {map_from_base_, covariance_.topLeftCorner<3, 3>()}; }
  const Eigen::Vector3d& rates() const { return rates_; }  // s, b in rad/m, t
  const Matrix6d& covariance() const { return covariance_; }

 private:
  OdometryNoise noise_;
  Pose2 map_from_base_;
  Eigen::Vector3d rates_ = Eigen::Vector3d::Zero();
  Matrix6d covariance_ = Matrix6d::Zero();  // x, y, yaw, s, b, t
};

}  // namespace cornerstone
