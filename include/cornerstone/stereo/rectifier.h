// Turns the raw image of one camera (lens distortion, its own orientation) into the rectified one that
// matching needs: x_raw = K distort(R' P^-1 x_rectified), cv::initUndistortRectifyMap. Where the raw camera
// saw nothing, the nearest pixel it saw is repeated, which gives correlation no edge to hold on to.
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/stereo/calibration.h"

namespace cornerstone {

class Rectifier {
 public:
  // Throws InputError naming camera and field: K or P without focal length, NaN, R no rotation, an unknown
  // number of distortion coefficients.
  explicit Rectifier(const CameraCalibration& calibration);
  // `rectified` is reused from call to call. Throws InputError when the raw image has another size than
  // calibrated.
  void rectify(const cv::Mat1b& raw, cv::Mat1b& rectified) const;

 private:
  std::string name_;
  cv::Size image_size_px_;
  cv::Mat map_fixed_point_;  // whole raw pixels, and in map_fraction_ their 1/32
  cv::Mat map_fraction_;
};

}  // namespace cornerstone
