// The whole chain of one robot without ROS: images and odometry in, a map and its landmarks out. Nodelets
// call the same stages one by one; tests and benchmarks run them here.
//
// The map's frame is the robot's odom frame at its first image. Metres and radians. InputError on images that
// do not fit the rig and on odometry that is not finite: then nothing changes.
#pragma once

#include <Eigen/Geometry>

#include <optional>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/mapping/mapper.h"
#include "cornerstone/registration/register_maps.h"
#include "cornerstone/scan/column_scan.h"
#include "cornerstone/stereo/self_calibration.h"
#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

struct PipelineParams {
  StereoParams stereo;
  ScanParams scan;
  MapperParams mapper;
  LandmarkParams landmarks;
};
void describe(ParamVisitor& visitor, PipelineParams& params);

struct StereoMounting {
  TrinocularRig rig;
  Eigen::Isometry3d base_from_camera;  // the reference camera's optical frame in the base's
};

class RobotPipeline {
 public:
  RobotPipeline(const StereoMounting& mounting, const PipelineParams& params);
  // One set of images and the odometry of their instant.
  MapperUpdate update(const StereoImages& images, const Pose2& odom_from_base);

  const Mapper& mapper() const { return mapper_; }
  GridMap map() const { return mapper_.map(); }
  Landmarks landmarks() const { return detectLandmarks(map(), params_.landmarks); }

 private:
  StereoMounting mounting_;
  PipelineParams params_;
  StereoMatcher matcher_;
  SelfCalibration self_calibration_;
  Mapper mapper_;
};

// The pose of the current robot's map in the reference robot's, or none; `refusal` says why in words.
std::optional<Registration> registerRobots(const RobotPipeline& reference, const RobotPipeline& current,
                                           const RegistrationParams& params, std::string* refusal = nullptr);

}  // namespace cornerstone
