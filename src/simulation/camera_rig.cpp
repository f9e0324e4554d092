#include "cornerstone/simulation/camera_rig.h"

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, RigParams& params) {
  visitor.field("width_px", params.width_px);
  visitor.field("height_px", params.height_px);
  visitor.degrees("field_of_view_deg", params.field_of_view_rad);
  visitor.field("baseline_m", params.baseline_m);
  visitor.field("height_m", params.height_m);
  visitor.field("forward_m", params.forward_m);
  visitor.degrees("pitch_deg", params.pitch_rad);
}

void describe(ParamVisitor& visitor, CameraFaultParams& params) {
  visitor.field("noise_grey", params.noise_grey);
  visitor.field("gain_difference", params.gain_difference);
  visitor.field("rectification_error_px", params.rectification_error_px);
  visitor.field("dropped_share", params.dropped_share);
}

double focalLength(const RigParams& params) {
  requireWithin(params.width_px, 8, 4096, "rig/width_px");
  requireWithin(params.height_px, 8, 4096, "rig/height_px");
  requireWithin(params.field_of_view_rad, 0.1, 2.8, "rig/field_of_view_deg (in radians)");
  requirePositive(params.baseline_m, "rig/baseline_m");
  requirePositive(params.height_m, "rig/height_m");
  return params.width_px / 2.0 / std::tan(params.field_of_view_rad / 2);
}

std::array<CameraCalibration, kCameraCount> calibrationsOf(const RigParams& params) {
  const double focal_px = focalLength(params);
  std::array<CameraCalibration, kCameraCount> calibrations;
  for (std::size_t i = 0; i < kCameraCount; ++i) {
    CameraCalibration& camera = calibrations[i];
    camera.name = kCameraNames[i];
    camera.image_size_px = {params.width_px, params.height_px};
    camera.intrinsics_px << focal_px, 0, (params.width_px - 1) / 2.0, 0, focal_px,
        (params.height_px - 1) / 2.0, 0, 0, 1;
    camera.distortion.assign(5, 0.0);
    camera.rectification.setIdentity();
    camera.projection_px.setZero();
    camera.projection_px.leftCols<3>() = camera.intrinsics_px;
  }
  // A camera displaced by t in the reference's optical frame has P(., 3) = -f t: right at x = B, top at y =
  // -B.
  calibrations[1].projection_px(0, 3) = -focal_px * params.baseline_m;
  calibrations[2].projection_px(1, 3) = focal_px * params.baseline_m;
  return calibrations;
}

std::array<Eigen::Isometry3d, kCameraCount> baseFromCameras(const RigParams& params) {
  Eigen::Isometry3d reference = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d level;
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  reference.linear() = Eigen::AngleAxisd(params.pitch_rad, Eigen::Vector3d::UnitY()) * level;
  reference.translation() = Eigen::Vector3d(params.forward_m, 0, params.height_m);
  const Eigen::Translation3d right(params.baseline_m, 0, 0), top(0, -params.baseline_m, 0);
  return {reference, reference * right, reference * top};
}

CameraFaults::CameraFaults(const CameraFaultParams& params, double focal_px, std::uint64_t seed)
    : params_(params), generator_(seed) {
  requireWithin(params.noise_grey, 0, 100, "cameras/noise_grey");
  requireWithin(params.gain_difference, 0, 0.9, "cameras/gain_difference");
  requireWithin(params.rectification_error_px, 0, 10, "cameras/rectification_error_px");
  requireWithin(params.dropped_share, 0, 1, "cameras/dropped_share");
  misalignments_[0].setIdentity();
  const double tilt_rad = params.rectification_error_px / focal_px;
  for (std::size_t i = 1; i < kCameraCount; ++i) {
    gains_[i] = 1 + generator_.uniform(-1.0, 1.0) * params.gain_difference;
    Eigen::Vector3d axis;
    for (int k = 0; k < 3; ++k) axis[k] = generator_.uniform(-1.0, 1.0) * tilt_rad;
    misalignments_[i] = Eigen::AngleAxisd(axis.norm(), axis.norm() > 0 ? Eigen::Vector3d(axis.normalized())
                                                                       : Eigen::Vector3d::UnitX())
                            .toRotationMatrix();
  }
}

cv::Mat1b CameraFaults::expose(const cv::Mat1f& grey, std::size_t camera) {
  cv::Mat1f noise(grey.size());
  generator_.fill(noise, cv::RNG::NORMAL, 0.0, params_.noise_grey);
  cv::scaleAdd(grey, gains_.at(camera), noise, noise);
  cv::Mat1b image;
  noise.convertTo(image, CV_8U);
  return image;
}

bool CameraFaults::dropsNext() { return generator_.uniform(0.0, 1.0) < params_.dropped_share; }

}  // namespace cornerstone
