// What the simulation gives, as messages: shared by the simulator nodelet and the bag writer, so that both
// publish alike.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/UInt32.h>

#include <array>
#include <string>

#include "cornerstone/simulation/simulation.h"

namespace cornerstone {

struct SimulatorParams {              // config/simulator.yaml
  std::string world = "office.yaml";  // path of the world's file
  double rate_factor = 1.0;           // simulated seconds in a second, at most
  double start_s = 1000;              // stamp of the start: not 0, which means "newest" to tf
  double start_delay_s =
      2;  // robots stand so long, publishing, before they drive: the others need to start, too
  bool wait_for_subscribers = true;  // ... and until somebody takes every robot's reference images
  SimulationParams simulation;
};
void describe(ParamVisitor& visitor, SimulatorParams& params);

// The stamp of a simulated time, in whole nanoseconds.
ros::Time stampOf(const SimulatorParams& params, double time_s);

// Motion and truth: at every step.
struct MotionMessages {
  nav_msgs::Odometry odometry;      // <robot>/odom -> <robot>/base_link
  nav_msgs::Odometry ground_truth;  // world -> <robot>/base_link; never in tf
  geometry_msgs::TransformStamped odom_from_base;
};
MotionMessages motionMessages(const RobotFrame& frame, const ros::Time& stamp);

// Images: `cameras` is empty when the triple was dropped.
struct CameraMessages {
  sensor_msgs::ImagePtr image;
  sensor_msgs::CameraInfo info;
};
std::vector<CameraMessages> cameraMessages(const RobotFrame& frame,
                                           const std::array<CameraCalibration, kCameraCount>& calibrations,
                                           const ros::Time& stamp);

}  // namespace cornerstone
