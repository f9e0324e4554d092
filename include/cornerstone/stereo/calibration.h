// One camera's calibration in plain values, with the meaning of sensor_msgs/CameraInfo (K, D, R, P).
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace cornerstone {

struct CameraCalibration {
  std::string name;                           // for messages: a topic or a file
  cv::Size image_size_px;                     // as calibrated
  Eigen::Matrix3d intrinsics_px;              // K
  std::vector<double> distortion;             // D, plumb_bob order; empty: none
  Eigen::Matrix3d rectification;              // R
  Eigen::Matrix<double, 3, 4> projection_px;  // P; P(0,3) = -f B_x, P(1,3) = -f B_y in px m
};

}  // namespace cornerstone
