// What a calibration is written to: CameraInfo files that camera_info_manager reads, and a picture.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cornerstone/stereo/rig_calibration.h"

namespace cornerstone {

// Images that a folder holds or a pattern ("board/left*.png") matches, by name. InputError when there are
// none.
std::vector<std::string> imagesAt(const std::string& where);

// In the form of camera_calibration_parsers.
std::string cameraInfoYaml(const CameraCalibration& camera);

// Beside one another for each pair: where the corners lie in the rectified reference image, and from each a
// line that is its epipolar error, 50 times enlarged.
cv::Mat3b epipolarPicture(const RigCalibration& rig);

}  // namespace cornerstone
