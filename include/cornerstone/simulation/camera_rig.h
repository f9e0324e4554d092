// The simulated rig: a reference camera, one to its right and one above it (an L), and what is wrong with
// real ones. Base frame: x forward, y left, z up, origin on the floor. Optical frames: z forward, x right, y
// down.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "cornerstone/base/params.h"
#include "cornerstone/stereo/calibration.h"

namespace cornerstone {

constexpr std::size_t kCameraCount = 3;
constexpr std::array<const char*, kCameraCount> kCameraNames{"reference", "right", "top"};

struct RigParams {
  int width_px = 160;  // the paper's images
  int height_px = 120;
  double field_of_view_rad = 1.5707963267948966;  // horizontal, whole angle (paper: 90 degrees)
  double baseline_m = 0.12;                       // reference to right and reference to top
  double height_m = 0.4;                          // of the reference camera above the floor
  double forward_m = 0.0;                         // of the cameras before the base's origin
  double pitch_rad = 0;                           // downwards positive
};
void describe(ParamVisitor& visitor, RigParams& params);

struct CameraFaultParams {
  double noise_grey = 1.0;              // standard deviation: a fair camera indoors
  double gain_difference = 0.02;        // right and top are brighter or darker by up to this share
  double rectification_error_px = 0.1;  // largest offset left over by calibration, in each direction
  double dropped_share = 0;             // of all image triples, lost at random
};
void describe(ParamVisitor& visitor, CameraFaultParams& params);

double focalLength(const RigParams& params);  // px
std::array<CameraCalibration, kCameraCount> calibrationsOf(const RigParams& params);
std::array<Eigen::Isometry3d, kCameraCount> baseFromCameras(const RigParams& params);

// The faults of one robot's cameras: gains and misalignments drawn once, noise drawn for each image.
class CameraFaults {
 public:
  CameraFaults(const CameraFaultParams& params, double focal_px, std::uint64_t seed);
  // The small turn of a camera that its calibration does not know of.
  const Eigen::Matrix3d& misalignment(std::size_t camera) const { return misalignments_.at(camera); }
  cv::Mat1b expose(const cv::Mat1f& grey, std::size_t camera);
  bool dropsNext();

 private:
  CameraFaultParams params_;
  cv::RNG generator_;
  std::array<double, kCameraCount> gains_{1, 1, 1};
  std::array<Eigen::Matrix3d, kCameraCount> misalignments_;
};

}  // namespace cornerstone
