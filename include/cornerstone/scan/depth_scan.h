// From a metric depth image (RGB-D, 32FC1 in m or 16UC1 in mm) to a range scan: the same columns as stereo's.
#pragma once

#include "cornerstone/scan/column_scan.h"

namespace cornerstone {

struct DepthNoise {
  // sigma_Z = a Z^2: structured light and active stereo, about 3 mm at 1 m.
  double sigma_m_per_m2 = 0.003;
  double common_ratio = 0.005;  // error of the scale of all depths together
};
void describe(ParamVisitor& visitor, DepthNoise& noise);

struct DepthImage {
  cv::Mat depth;  // CV_32F in m or CV_16U in mm; 0, NaN, infinite: no answer
  double focal_px = 0;
  double centre_x_px = 0;
  double centre_y_px = 0;
};

// Throws InputError when the image has another type or is empty, or the focal length is not positive.
RangeScan scanFromDepth(const DepthImage& image, const DepthNoise& noise,
                        const Eigen::Isometry3d& base_from_camera, const ScanParams& params);

}  // namespace cornerstone
