// A common orientation for two or three mounted cameras: x along the baseline to the second, y as near to the
// baseline to the third as an image axis can be.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "cornerstone/stereo/calibration.h"

namespace cornerstone {

struct CommonOrientation {
  Eigen::Matrix3d rectified_from_reference;
  double skew_rad = 0;  // by how much the angle of the baselines is not 0 or 90 degrees
};

// reference_from_camera: poses of all cameras, the reference itself first. No answer where two cameras stand
// in one place, or where the second one does not stand beside the reference camera as it looks.
std::optional<CommonOrientation> commonOrientation(
    const std::vector<Eigen::Isometry3d>& reference_from_camera);

// Sets R and P of each camera: one focal length and principal point, so that what the cameras see together
// fills the images. `intrinsics_px` and `distortion` are those of the raw images.
void rectifyRig(const std::vector<Eigen::Isometry3d>& reference_from_camera,
                const CommonOrientation& orientation, std::vector<CameraCalibration>& cameras);

}  // namespace cornerstone
