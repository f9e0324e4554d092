#include "cornerstone/pipeline/robot_pipeline.h"

#include <utility>

namespace cornerstone {

void describe(ParamVisitor& visitor, PipelineParams& params) {
  visitor.group("stereo", [&] { describe(visitor, params.stereo); });
  visitor.group("scan", [&] { describe(visitor, params.scan); });
  visitor.group("mapper", [&] { describe(visitor, params.mapper); });
  visitor.group("landmarks", [&] { describe(visitor, params.landmarks); });
}

RobotPipeline::RobotPipeline(const StereoMounting& mounting, const PipelineParams& params)
    : mounting_(mounting),
      params_(params),
      matcher_(params.stereo),
      mapper_(params.mapper, params.scan.levels.size()) {}

MapperUpdate RobotPipeline::update(const StereoImages& images, const Pose2& odom_from_base) {
  Disparity disparity = matcher_.match(images, mounting_.rig);
  self_calibration_.correct(images, disparity);
  const RangeScan scan = scanFromDisparity(disparity, mounting_.base_from_camera, params_.scan);
  return mapper_.update(scan, odom_from_base);
}

std::optional<Registration> registerRobots(const RobotPipeline& reference, const RobotPipeline& current,
                                           const RegistrationParams& params, std::string* refusal) {
  const GridMap reference_map = reference.map(), current_map = current.map();
  const Landmarks reference_landmarks = reference.landmarks(), current_landmarks = current.landmarks();
  RegistrationOutcome outcome =
      registerMaps({reference_map, reference_landmarks, reference.mapper().way()},
                   {current_map, current_landmarks, current.mapper().way()}, {}, params);
  if (refusal != nullptr) *refusal = outcome.refusal;
  return std::move(outcome.registration);
}

}  // namespace cornerstone
