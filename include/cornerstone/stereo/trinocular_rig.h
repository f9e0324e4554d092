// The geometry of a rectified rig: a reference camera, one beside it (right) and, if there is one, a third.
//
// All disparities are those of the reference pair: d = f B / Z in px, Z along the reference camera's optical
// axis. A reference pixel (x, y) with disparity d is seen by a secondary camera at (x + d * shift.x, y + d *
// shift.y):
// (-1, 0) for the right camera, (0, +1) for a top camera with the same baseline.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "cornerstone/stereo/calibration.h"

namespace cornerstone {

struct TrinocularRig {
  cv::Size image_size_px;
  double focal_px = 0;
  double centre_x_px = 0;  // principal point of the reference camera
  double centre_y_px = 0;
  double baseline_m = 0;  // reference to right, > 0
  cv::Point2d right_shift{-1, 0};
  std::optional<cv::Point2d> top_shift;  // empty: two cameras

  double rangeOf(double disparity_px) const { return focal_px * baseline_m / disparity_px; }
  // What reference pixel (col, row) shows, in the reference camera's optical frame.
  Eigen::Vector3d pointOf(double col, double row, double disparity_px) const;
};

// Throws InputError that names the camera and the field: not calibrated (zeros), NaN, unequal sizes or focal
// lengths, a baseline that is zero, has the wrong sign or lies along neither image axis.
TrinocularRig makeRig(const CameraCalibration& reference, const CameraCalibration& right,
                      const std::optional<CameraCalibration>& top);

}  // namespace cornerstone
