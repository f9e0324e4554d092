// How far odometry may be wrong over a step: standard deviations that grow with the distance driven and turned.
#pragma once

#include "cornerstone/base/params.h"
#include "cornerstone/base/pose2.h"

namespace cornerstone {

// Systematic errors (a wheel too small) count here too: over one step they look like noise of their size.
struct OdometryNoise {
  double translation_per_m = 0.05;     // m of error along and across, per m driven
  double yaw_rad_per_m = 0.05;         // rad per m driven: about 3 degrees
  double yaw_per_rad = 0.05;           // rad per rad turned
  double translation_m_per_rad = 0.01; // m per rad turned: wheels slip
};
void describe(ParamVisitor& visitor, OdometryNoise& noise);
void requireValid(const OdometryNoise& noise);

// Covariance (x, y, yaw) of the step in the frame of its start.
Eigen::Matrix3d stepCovariance(const Pose2& from_to, const OdometryNoise& noise);

}  // namespace cornerstone
