#include "rig_rectification.h"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace cornerstone {
namespace {

constexpr double kSmallestBaseline_m = 1e-4;

// Mean of the directions in which cameras look.
Eigen::Vector3d meanAxis(const std::vector<Eigen::Isometry3d>& reference_from_camera) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : reference_from_camera) sum += pose.linear().col(2);
  return sum.normalized();
}

// Where the middle of the image's edges lies in the rectified image of focal length f around principal point
// 0.
cv::Point2d middleOf(const CameraCalibration& camera, double focal_px) {
  const double w = camera.image_size_px.width - 1, h = camera.image_size_px.height - 1;
  const std::vector<cv::Point2d> raw{{0, h / 2}, {w, h / 2}, {w / 2, 0}, {w / 2, h}};
  std::vector<cv::Point2d> rays;
  cv::Mat1d intrinsics, rotation;
  cv::eigen2cv(camera.intrinsics_px, intrinsics);
  cv::eigen2cv(camera.rectification, rotation);
  cv::undistortPoints(raw, rays, intrinsics, camera.distortion, rotation);
  return cv::Point2d((rays[0].x + rays[1].x) / 2, (rays[2].y + rays[3].y) / 2) * focal_px;
}

}  // namespace

std::optional<CommonOrientation> commonOrientation(
    const std::vector<Eigen::Isometry3d>& reference_from_camera) {
  const Eigen::Vector3d forward = meanAxis(reference_from_camera);
  const Eigen::Vector3d right = reference_from_camera[1].translation();
  if (right.norm() < kSmallestBaseline_m || right.cross(forward).norm() < 0.5 * right.norm())
    return std::nullopt;
  Eigen::Vector3d x = right.normalized(), y = forward.cross(x).normalized();
  CommonOrientation common;
  if (reference_from_camera.size() > 2) {
    const Eigen::Vector3d third = reference_from_camera[2].translation();
    if (third.norm() < kSmallestBaseline_m) return std::nullopt;
    const double along_x = third.normalized().dot(x);
    if (std::abs(along_x) < M_SQRT1_2) {
      // What the angle lacks of 90 degrees is shared by both axes.
      const Eigen::Vector3d towards = third.dot(y) < 0 ? -third.normalized() : third.normalized();
      common.skew_rad = std::asin(std::abs(along_x));
      const Eigen::Vector3d sum = (x + towards).normalized(), difference = (x - towards).normalized();
      x = (sum + difference).normalized();
      y = (sum - difference).normalized();
    } else {
      common.skew_rad = std::acos(std::min(1.0, std::abs(along_x)));
    }
  }
  common.rectified_from_reference << x.transpose(), y.transpose(), x.cross(y).transpose();
  return common;
}

void rectifyRig(const std::vector<Eigen::Isometry3d>& reference_from_camera,
                const CommonOrientation& orientation, std::vector<CameraCalibration>& cameras) {
  const auto count = static_cast<double>(cameras.size());
  double focal_px = 0;
  for (const CameraCalibration& camera : cameras)
    focal_px += (camera.intrinsics_px(0, 0) + camera.intrinsics_px(1, 1)) / (2 * count);
  cv::Point2d middle;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].rectification = orientation.rectified_from_reference * reference_from_camera[i].linear();
    middle += middleOf(cameras[i], focal_px) / count;
  }
  const cv::Size size = cameras[0].image_size_px;
  const double centre_x = (size.width - 1) / 2.0 - middle.x, centre_y = (size.height - 1) / 2.0 - middle.y;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Eigen::Vector3d at_m =
        orientation.rectified_from_reference * reference_from_camera[i].translation();
    const bool vertical = std::abs(at_m.y()) > std::abs(at_m.x());
    cameras[i].projection_px << focal_px, 0, centre_x, vertical ? 0 : -focal_px * at_m.x(),  //
        0, focal_px, centre_y, vertical ? -focal_px * at_m.y() : 0,                          //
        0, 0, 1, 0;
  }
}

}  // namespace cornerstone
