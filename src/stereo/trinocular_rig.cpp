#include "cornerstone/stereo/trinocular_rig.h"

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// Rectified cameras have one focal length and one principal point up to the digits a calibration file is
// written with.
constexpr double kFocalTolerance = 1e-4;      // relative: 0.01 px of disparity at 100 px
constexpr double kCentreTolerance_px = 0.01;  // a disparity offset: 0.3% of range at 3 px
constexpr double kAcrossTolerance = 0.005;    // baseline's part across its axis: half a row at 100 px
constexpr double kSmallestBaseline_focals =
    1e-6;  // below: a P without baseline (in m, focal length divided out)

void requireCalibrated(const CameraCalibration& camera) {
  const auto& projection = camera.projection_px;
  if (!projection.allFinite()) throw InputError(camera.name + ": P holds NaN or infinity");
  if (camera.image_size_px.width <= 0 || camera.image_size_px.height <= 0)
    throw InputError(camera.name + ": image size is zero: not calibrated");
  if (projection(0, 0) <= 0 || projection(1, 1) <= 0)
    throw InputError(camera.name + ": focal length in P is not positive: not calibrated");
  if (std::abs(projection(0, 0) - projection(1, 1)) > kFocalTolerance * projection(0, 0))
    throw InputError(camera.name + ": P has unequal focal lengths in x and y: not rectified");
}

void requireAlike(const CameraCalibration& reference, const CameraCalibration& other) {
  if (other.image_size_px != reference.image_size_px)
    throw InputError(other.name + ": image size differs from that of " + reference.name);
  const auto &p = reference.projection_px, &q = other.projection_px;
  if (std::abs(q(0, 0) - p(0, 0)) > kFocalTolerance * p(0, 0))
    throw InputError(other.name + ": focal length in P differs from that of " + reference.name);
  if (std::abs(q(0, 2) - p(0, 2)) > kCentreTolerance_px || std::abs(q(1, 2) - p(1, 2)) > kCentreTolerance_px)
    throw InputError(other.name + ": principal point in P differs from that of " + reference.name);
}

// Where a camera stands in the reference camera's image axes, in m: P(., 3) = -f t.
cv::Point2d positionOf(const CameraCalibration& reference, const CameraCalibration& other) {
  const Eigen::Vector2d offset_px_m =
      (other.projection_px.col(3) - reference.projection_px.col(3)).head<2>() / reference.projection_px(0, 0);
  return {-offset_px_m.x(), -offset_px_m.y()};
}

void requireAlongAxis(const CameraCalibration& camera, const cv::Point2d& position_m) {
  const double along = std::max(std::abs(position_m.x), std::abs(position_m.y));
  const double across = std::min(std::abs(position_m.x), std::abs(position_m.y));
  if (along < kSmallestBaseline_focals)
    throw InputError(camera.name + ": baseline is zero (P(0,3) and P(1,3) equal the reference camera's)");
  if (across > kAcrossTolerance * along)
    throw InputError(camera.name + ": baseline lies along neither image axis (P(0,3), P(1,3))");
}

}  // namespace

Eigen::Vector3d TrinocularRig::pointOf(double col, double row, double disparity_px) const {
  const double metres_per_px = baseline_m / disparity_px;
  return {(col - centre_x_px) * metres_per_px, (row - centre_y_px) * metres_per_px, focal_px * metres_per_px};
}

TrinocularRig makeRig(const CameraCalibration& reference, const CameraCalibration& right,
                      const std::optional<CameraCalibration>& top) {
  requireCalibrated(reference);
  requireCalibrated(right);
  requireAlike(reference, right);
  const cv::Point2d right_m = positionOf(reference, right);
  requireAlongAxis(right, right_m);
  if (std::abs(right_m.y) > std::abs(right_m.x))
    throw InputError(right.name + ": baseline lies along the image's y axis: this is no right camera");
  if (right_m.x < 0)
    throw InputError(right.name + ": baseline is negative (P(0,3) > 0): left and right camera swapped?");

  TrinocularRig rig;
  rig.image_size_px = reference.image_size_px;
  rig.focal_px = reference.projection_px(0, 0);
  rig.centre_x_px = reference.projection_px(0, 2);
  rig.centre_y_px = reference.projection_px(1, 2);
  rig.baseline_m = right_m.x;
  if (top) {
    requireCalibrated(*top);
    requireAlike(reference, *top);
    const cv::Point2d top_m = positionOf(reference, *top);
    requireAlongAxis(*top, top_m);
    const bool beside = std::abs(top_m.x) > std::abs(top_m.y);
    rig.top_shift =
        beside ? cv::Point2d(-top_m.x / rig.baseline_m, 0) : cv::Point2d(0, -top_m.y / rig.baseline_m);
  }
  return rig;
}

}  // namespace cornerstone
