#include "cornerstone/stereo/rectifier.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// How far R'R may be from the identity, per entry: calibration files are written with 6 digits or more.
constexpr double kRotationTolerance = 1e-4;

void requireUsable(const CameraCalibration& calibration) {
  const std::string& name = calibration.name;
  if (calibration.image_size_px.width <= 0 || calibration.image_size_px.height <= 0)
    throw InputError(name + ": image size is zero: not calibrated");
  if (!calibration.intrinsics_px.allFinite()) throw InputError(name + ": K holds NaN");
  if (!calibration.projection_px.allFinite()) throw InputError(name + ": P holds NaN");
  for (int i = 0; i < 2; ++i) {
    requirePositive(calibration.intrinsics_px(i, i), name + ": focal length in K");
    requirePositive(calibration.projection_px(i, i), name + ": focal length in P");
  }
  const Eigen::Matrix3d& rotation = calibration.rectification;
  const double skew = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < kRotationTolerance) || rotation.determinant() < 0)
    throw InputError(name + ": R is not a rotation");
  constexpr std::array<std::size_t, 6> kKnownCounts{0, 4, 5, 8, 12, 14};  // of cv::undistort
  const std::size_t count = calibration.distortion.size();
  if (std::find(kKnownCounts.begin(), kKnownCounts.end(), count) == kKnownCounts.end())
    throw InputError(name + ": D has " + std::to_string(count) +
                     " coefficients; 0, 4, 5, 8, 12 or 14 are known");
  for (const double coefficient : calibration.distortion) requireFinite(coefficient, name + ": D");
}

}  // namespace

Rectifier::Rectifier(const CameraCalibration& calibration)
    : name_(calibration.name), image_size_px_(calibration.image_size_px) {
  requireUsable(calibration);
  cv::Mat intrinsics, rectification, projection;
  cv::eigen2cv(calibration.intrinsics_px, intrinsics);
  cv::eigen2cv(calibration.rectification, rectification);
  const Eigen::Matrix3d projection_matrix = calibration.projection_px.leftCols<3>();
  cv::eigen2cv(projection_matrix, projection);
  cv::initUndistortRectifyMap(intrinsics, calibration.distortion, rectification, projection, image_size_px_,
                              CV_16SC2, map_fixed_point_, map_fraction_);
}

void Rectifier::rectify(const cv::Mat1b& raw, cv::Mat1b& rectified) const {
  if (raw.size() != image_size_px_)
    throw InputError(name_ + ": image is " + std::to_string(raw.cols) + "x" + std::to_string(raw.rows) +
                     ", its calibration is for " + std::to_string(image_size_px_.width) + "x" +
                     std::to_string(image_size_px_.height));
  cv::remap(raw, rectified, map_fixed_point_, map_fraction_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
}

}  // namespace cornerstone
