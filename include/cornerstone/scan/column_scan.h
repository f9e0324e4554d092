// From a disparity image to one range per image column (paper, section 2.1 and Fig. 2): the nearest surface
// within a height band that enough pixels of the column agree on.
#pragma once

#include <Eigen/Geometry>

#include "cornerstone/base/params.h"
#include "cornerstone/scan/range_scan.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

struct ScanParams {
  double z_min_m = 0.15;  // above the floor: lower points are floor
  double z_max_m = 1.50;  // higher points do not hinder the robot
  // (the owner of this area adds the rest, each with unit and reason)
};
void describe(ParamVisitor& visitor, ScanParams& params);

// base_from_camera: pose of the reference camera's optical frame (z forward, x right, y down) in the base
// frame (x forward, z up, origin on the floor). The scan's sensor frame lies at the camera, heading along its
// optical axis.
RangeScan scanFromDisparity(const Disparity& disparity, const Eigen::Isometry3d& base_from_camera,
                            const ScanParams& params);

}  // namespace cornerstone
