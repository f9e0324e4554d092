// A rigid motion of the plane, named a_from_b: it maps coordinates in frame b to frame a, so that
// a_from_b * b_from_c is a_from_c. Metres and radians; yaw counter-clockwise, kept in (-pi, pi].
#pragma once

#include <Eigen/Core>

namespace cornerstone {

// The same angle in (-pi, pi].
double wrapAngle(double angle_rad);

struct Pose2 {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;

  Eigen::Vector2d translation() const { return {x_m, y_m}; }
  Eigen::Matrix2d rotation() const;
  Pose2 inverse() const;
  bool isFinite() const;
};

Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c);
Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b_m);

// The same for many points: sine and cosine are worked out once.
struct PointMotion {
  explicit PointMotion(const Pose2& a_from_b)
      : rotation(a_from_b.rotation()), translation_m(a_from_b.translation()) {}
  Eigen::Vector2d operator*(const Eigen::Vector2d& point_in_b_m) const {
    return rotation * point_in_b_m + translation_m;
  }

  Eigen::Matrix2d rotation;
  Eigen::Vector2d translation_m;
};

// The covariance (x, y, yaw) of a_from_c = a_from_b * b_from_c, both parts independent, first order.
Eigen::Matrix3d composeCovariance(const Pose2& a_from_b, const Eigen::Matrix3d& covariance_ab,
                                  const Pose2& b_from_c, const Eigen::Matrix3d& covariance_bc);

}  // namespace cornerstone
