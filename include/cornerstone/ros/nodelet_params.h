// Parameters of the nodelets: their own and those of the stages they call. One YAML file of config/ for each
// struct.
#pragma once

#include <string>
#include <vector>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/mapping/mapper.h"
#include "cornerstone/registration/registration_tracker.h"
#include "cornerstone/ros/frame_names.h"
#include "cornerstone/scan/column_scan.h"
#include "cornerstone/scan/depth_scan.h"
#include "cornerstone/scan/laser_scan.h"
#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

struct TrinocularStereoParams {       // config/stereo.yaml
  std::string images = "image_rect";  // or image_raw: rectified here with each camera's calibration
  bool third_camera = true;           // false: reference and right only
  // The third camera silent for so long: the others go on alone. 0: never. Some ten images at 10 Hz.
  double third_camera_silence_s = 1.0;
  // Largest difference between the stamps of one set; 0: equal stamps. Cameras with a common trigger differ
  // by less than a millisecond; at 1 m/s and 3 m range 10 ms already shift the image by a quarter of a pixel.
  double sync_tolerance_s = 0.0;
  int queue_size = 5;  // sets that may wait; more only delays what is shown
  // Cameras turned against their calibration by hundredths of a degree are found out and disparities
  // corrected.
  bool self_calibration = true;
  StereoParams stereo;
};
void describe(ParamVisitor& visitor, TrinocularStereoParams& params);

struct OccupancyMapperParams {  // config/mapper.yaml
  std::string robot = "robot";
  FrameNames frames;
  std::string input = "disparity";  // or depth, scan
  // Standard deviation of every disparity, px; 0: the topic disparity_sigma tells it pixel by pixel.
  double disparity_sigma_px = 0.0;
  // A scan waits this long for the odometry of its instant, then it is dropped. Drivers publish at 10 Hz or
  // faster.
  double tf_timeout_s = 0.5;
  double publish_period_s =
      0.5;                    // of the map and its tiles; at most 2 Hz keeps the picture fresh at little cost
  double tf_period_s = 0.05;  // of map -> odom
  // Pitch and roll of the robot from its odometry (an IMU's, as a rule); false where they are noise, and on
  // ramps that the robot shall not take for walls.
  bool use_tilt = true;
  // A saved map to go on in, and where the robot stands in it at the start; empty: an empty map, whose frame
  // is odom at the first scan. A reset begins there again.
  std::string load_map;
  Pose2 start;
  ScanParams scan;
  DepthNoise depth;
  LaserParams laser;
  MapperParams mapper;
};
void describe(ParamVisitor& visitor, OccupancyMapperParams& params);

// A rough pose of this robot's map in the reference robot's, known beforehand: a common start, a measured
// one.
struct InitialPose {
  bool known = false;  // false: any pose is possible
  Pose2 reference_from_current;
};
void describe(ParamVisitor& visitor, InitialPose& pose);

struct RegistrationNodeletParams {  // config/registration.yaml
  std::string robot = "robot";
  std::string reference_robot;  // empty, or this robot itself: it is the reference and registers to nobody
  // Robots that may stand in between where this one's map has nothing in common with the reference robot's,
  // and whose maps merged_map holds, too.
  std::vector<std::string> other_robots;
  FrameNames frames;
  std::string reference_map_frame;  // empty: <reference robot>/map
  double period_s = 1.0;            // between attempts; maps change little in less
  double tf_period_s = 0.1;         // of the shared frame, while there is one
  double tf_smoothing_s = 0.5;      // time constant with which it follows a new estimate: no jumps
  InitialPose initial;
  LandmarkParams landmarks;
  RegistrationParams registration;
  TrackerParams tracker;
};
void describe(ParamVisitor& visitor, RegistrationNodeletParams& params);

}  // namespace cornerstone
