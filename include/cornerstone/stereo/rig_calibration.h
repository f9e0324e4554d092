// Calibration of two or three cameras from images of one chessboard: lenses, mounting, and the rectification
// that turns the raw images into those of a rig (trinocular_rig.h): right along the image rows, the third
// camera along the rows or the columns. Board and mounting in m, frames optical (z forward, x right, y down).
//
// Each camera's lens is solved from all its boards (Zhang, 2000; cv::calibrateCamera); from there, pair by
// pair, both lenses and the mounting together from all boards that both have seen (cv::stereoCalibrate), and
// at last each mounting with the lenses that this ended with. A common frame is chosen whose x axis is the
// baseline to the right camera and whose y axis is as near as can be to the third camera's; what their angle
// lacks of 90 degrees is shared by both and reported as epipolar error. Fails where too few boards are seen
// by both cameras of a pair, or where the boards contradict each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cornerstone/stereo/calibration.h"
#include "cornerstone/stereo/chessboard.h"

namespace cornerstone {

struct CameraViews {
  std::string name;                               // reference, right, top
  std::vector<std::vector<cv::Point2f>> corners;  // by image set; empty: board not found
};

struct CalibrationParams {
  // Boards that both cameras of a pair must have seen; with fewer, lens and mounting cannot be told apart.
  int smallest_sets = 5;
  // Root mean square of the corners' distances from where the solution puts them. Above, something is wrong:
  // the board's size, unsynchronised images, a board that is not flat. Good cameras reach 0.1 to 0.3.
  double largest_rms_px = 1.0;
  // Between the baselines to the right and the third camera and the nearest of 0 and 90 degrees.
  double largest_skew_rad = 0.1;
};

struct PairReport {
  std::string name;            // of the secondary camera
  int sets = 0;                // boards seen by both
  double rms_px = 0;           // of the joint solution
  double epipolar_rms_px = 0;  // across the baseline, in the rectified images
  double baseline_m = 0;
  std::vector<cv::Point2f> at_px;  // rectified reference corners, and the error of each across the baseline
  std::vector<float> errors_px;
};

struct RigCalibration {
  std::vector<CameraCalibration> cameras;  // in the order given
  std::vector<double> rms_px;              // of each camera's lens alone
  std::vector<PairReport> pairs;           // of each camera but the first
};

// cameras: reference, right and, if there is one, the third. Throws InputError on sets of unequal number or
// too few boards; the text of `why` names what contradicts otherwise, and there is no answer.
std::optional<RigCalibration> calibrateRig(const std::vector<CameraViews>& cameras, cv::Size image_size_px,
                                           const Chessboard& board, std::string& why);

}  // namespace cornerstone
