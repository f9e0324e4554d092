#include "cornerstone/scan/depth_scan.h"

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, DepthNoise& noise) {
  visitor.field("sigma_m_per_m2", noise.sigma_m_per_m2);
  visitor.field("common_ratio", noise.common_ratio);
}

RangeScan scanFromDepth(const DepthImage& image, const DepthNoise& noise,
                        const Eigen::Isometry3d& base_from_camera, const ScanParams& params) {
  requirePositive(noise.sigma_m_per_m2, "sigma_m_per_m2");
  requireWithin(noise.common_ratio, 0, 1, "common_ratio");
  if (image.depth.empty()) throw InputError("depth image is empty");
  if (image.depth.type() != CV_32FC1 && image.depth.type() != CV_16UC1)
    throw InputError("depth image is neither 32FC1 (m) nor 16UC1 (mm)");
  cv::Mat1f depth_m;
  image.depth.convertTo(depth_m, CV_32F, image.depth.type() == CV_16UC1 ? 1e-3 : 1.0);

  InverseDepthImage inverse;
  inverse.inverse_depth = cv::Mat1f::zeros(depth_m.size());
  // sigma of 1/Z is sigma_Z / Z^2 = a: the same for all pixels.
  inverse.sigma = cv::Mat1f(depth_m.size(), static_cast<float>(noise.sigma_m_per_m2));
  for (int v = 0; v < depth_m.rows; ++v)
    for (int u = 0; u < depth_m.cols; ++u)
      if (std::isfinite(depth_m(v, u)) && depth_m(v, u) > 0) inverse.inverse_depth(v, u) = 1 / depth_m(v, u);
  // The scale's error is taken at 2 m, the middle of what such cameras see.
  inverse.common_sigma = noise.common_ratio / 2;
  inverse.focal_px = image.focal_px;
  inverse.centre_x_px = image.centre_x_px;
  inverse.centre_y_px = image.centre_y_px;
  return scanFromInverseDepth(inverse, base_from_camera, params);
}

}  // namespace cornerstone
