#include "cornerstone/mapping/odometry_noise.h"

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, OdometryNoise& noise) {
  visitor.field("translation_per_m", noise.translation_per_m);
  visitor.field("yaw_rad_per_m", noise.yaw_rad_per_m);
  visitor.field("yaw_per_rad", noise.yaw_per_rad);
  visitor.field("translation_m_per_rad", noise.translation_m_per_rad);
}

void requireValid(const OdometryNoise& noise) {
  requireWithin(noise.translation_per_m, 1e-4, 1, "translation_per_m");
  requireWithin(noise.yaw_rad_per_m, 1e-4, 3, "yaw_rad_per_m");
  requireWithin(noise.yaw_per_rad, 1e-4, 1, "yaw_per_rad");
  requireWithin(noise.translation_m_per_rad, 0, 1, "translation_m_per_rad");
}

Eigen::Matrix3d stepCovariance(const Pose2& from_to, const OdometryNoise& noise) {
  // A robot that stands is known to stand, but for a tenth of a millimetre and a hundredth of a degree.
  constexpr double kStill_m = 1e-4, kStill_rad = 2e-4;
  const double driven_m = from_to.translation().norm(), turned_rad = std::abs(from_to.yaw_rad);
  const double along_m =
      std::hypot(noise.translation_per_m * driven_m, noise.translation_m_per_rad * turned_rad) + kStill_m;
  const double yaw_rad = std::hypot(noise.yaw_rad_per_m * driven_m, noise.yaw_per_rad * turned_rad) + kStill_rad;
  return Eigen::Vector3d(along_m * along_m, along_m * along_m, yaw_rad * yaw_rad).asDiagonal();
}

}  // namespace cornerstone
