#include "cornerstone/ros/nodelet_params.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, TrinocularStereoParams& params) {
  visitor.field("images", params.images);
  visitor.field("third_camera", params.third_camera);
  visitor.field("third_camera_silence_s", params.third_camera_silence_s);
  visitor.field("sync_tolerance_s", params.sync_tolerance_s);
  visitor.field("queue_size", params.queue_size);
  visitor.field("self_calibration", params.self_calibration);
  visitor.group("stereo", [&] { describe(visitor, params.stereo); });
}

void describe(ParamVisitor& visitor, OccupancyMapperParams& params) {
  visitor.field("robot", params.robot);
  visitor.group("frames", [&] { describe(visitor, params.frames); });
  visitor.field("input", params.input);
  visitor.field("disparity_sigma_px", params.disparity_sigma_px);
  visitor.field("tf_timeout_s", params.tf_timeout_s);
  visitor.field("publish_period_s", params.publish_period_s);
  visitor.field("tf_period_s", params.tf_period_s);
  visitor.field("use_tilt", params.use_tilt);
  visitor.field("load_map", params.load_map);
  visitor.group("start", [&] {
    visitor.field("x_m", params.start.x_m);
    visitor.field("y_m", params.start.y_m);
    visitor.degrees("yaw_deg", params.start.yaw_rad);
  });
  visitor.group("scan", [&] { describe(visitor, params.scan); });
  visitor.group("depth", [&] { describe(visitor, params.depth); });
  visitor.group("laser", [&] { describe(visitor, params.laser); });
  visitor.group("mapper", [&] { describe(visitor, params.mapper); });
}

void describe(ParamVisitor& visitor, InitialPose& pose) {
  visitor.field("known", pose.known);
  visitor.field("x_m", pose.reference_from_current.x_m);
  visitor.field("y_m", pose.reference_from_current.y_m);
  visitor.degrees("yaw_deg", pose.reference_from_current.yaw_rad);
}

void describe(ParamVisitor& visitor, RegistrationNodeletParams& params) {
  visitor.field("robot", params.robot);
  visitor.field("reference_robot", params.reference_robot);
  visitor.field("other_robots", params.other_robots);
  visitor.group("frames", [&] { describe(visitor, params.frames); });
  visitor.field("reference_map_frame", params.reference_map_frame);
  visitor.field("period_s", params.period_s);
  visitor.field("tf_period_s", params.tf_period_s);
  visitor.field("tf_smoothing_s", params.tf_smoothing_s);
  visitor.group("initial", [&] { describe(visitor, params.initial); });
  visitor.group("landmarks", [&] { describe(visitor, params.landmarks); });
  visitor.group("registration", [&] { describe(visitor, params.registration); });
  visitor.group("tracker", [&] { describe(visitor, params.tracker); });
}

}  // namespace cornerstone
