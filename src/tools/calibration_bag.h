// Chessboards in the images of a recording.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cornerstone/stereo/rig_calibration.h"

namespace cornerstone {

struct CalibrationBag {
  std::string path;
  std::vector<std::string> topics;  // sensor_msgs/Image or CompressedImage: reference, right and, if any, top
  // Between the stamps of the images of one set; a board in a hand moves half a pixel in 5 ms (0.1 m/s, 0.5 m
  // away, 500 px focal length).
  double tolerance_s = 0.005;
};

// The boards by camera and set; `size` becomes that of the images. Sets whose board lies where an earlier
// one's lies are left out: a board held still counts once. InputError names the file, and the topic
// at fault.
std::vector<CameraViews> viewsInBag(const CalibrationBag& bag, const Chessboard& board, cv::Size& size);

}  // namespace cornerstone
