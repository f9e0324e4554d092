#include "cornerstone/base/pose2.h"

#include <cmath>

namespace cornerstone {

double wrapAngle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2 * M_PI);
  return wrapped <= -M_PI ? M_PI : wrapped;
}

Eigen::Matrix2d Pose2::rotation() const {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

Pose2 Pose2::inverse() const {
  const Eigen::Vector2d t = -(rotation().transpose() * translation());
  return {t.x(), t.y(), wrapAngle(-yaw_rad)};
}

bool Pose2::isFinite() const { return std::isfinite(x_m) && std::isfinite(y_m) && std::isfinite(yaw_rad); }

Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const Eigen::Vector2d t = a_from_b * b_from_c.translation();
  return {t.x(), t.y(), wrapAngle(a_from_b.yaw_rad + b_from_c.yaw_rad)};
}

Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b_m) {
  return a_from_b.rotation() * point_in_b_m + a_from_b.translation();
}

Eigen::Matrix3d composeCovariance(const Pose2& a_from_b, const Eigen::Matrix3d& covariance_ab,
                                  const Pose2& b_from_c, const Eigen::Matrix3d& covariance_bc) {
  const Eigen::Vector2d lever = a_from_b.rotation() * b_from_c.translation();
  Eigen::Matrix3d by_ab = Eigen::Matrix3d::Identity();
  by_ab(0, 2) = -lever.y();
  by_ab(1, 2) = lever.x();
  Eigen::Matrix3d by_bc = Eigen::Matrix3d::Identity();
  by_bc.topLeftCorner<2, 2>() = a_from_b.rotation();
  return by_ab * covariance_ab * by_ab.transpose() + by_bc * covariance_bc * by_bc.transpose();
}

}  // namespace cornerstone
