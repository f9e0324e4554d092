#include "cornerstone/ros/simulation_messages.h"

#include <sensor_msgs/image_encodings.h>

#include <cmath>

#include "cornerstone/ros/image_messages.h"
#include "cornerstone/ros/transforms.h"

namespace cornerstone {
namespace {

nav_msgs::Odometry odometryOf(const Pose2& parent_from_base, const Twist2& twist,
                              const std_msgs::Header& header, const std::string& child) {
  nav_msgs::Odometry odometry;
  odometry.header = header;
  odometry.child_frame_id = child;
  odometry.pose.pose = toPose(parent_from_base);
  odometry.twist.twist.linear.x = twist.v_m_s;
  odometry.twist.twist.angular.z = twist.w_rad_s;
  return odometry;
}

std_msgs::Header headerOf(const std::string& frame_id, const ros::Time& stamp) {
  std_msgs::Header header;
  header.frame_id = frame_id;
  header.stamp = stamp;
  return header;
}

}  // namespace

void describe(ParamVisitor& visitor, SimulatorParams& params) {
  visitor.field("world", params.world);
  visitor.field("rate_factor", params.rate_factor);
  visitor.field("start_s", params.start_s);
  visitor.field("start_delay_s", params.start_delay_s);
  visitor.field("wait_for_subscribers", params.wait_for_subscribers);
  describe(visitor, params.simulation);
}

ros::Time stampOf(const SimulatorParams& params, double time_s) {
  ros::Time stamp;
  return stamp.fromNSec(std::uint64_t(std::llround((params.start_s + time_s) * 1e9)));
}

MotionMessages motionMessages(const RobotFrame& frame, const ros::Time& stamp) {
  const std::string base = frame.robot + "/base_link", odom = frame.robot + "/odom";
  MotionMessages messages;
  messages.odometry = odometryOf(frame.odom_from_base, frame.twist, headerOf(odom, stamp), base);
  messages.ground_truth = odometryOf(frame.world_from_base, frame.twist, headerOf("world", stamp), base);
  messages.odom_from_base = toStamped(frame.odom_from_base, odom, base, stamp);
  return messages;
}

std::vector<CameraMessages> cameraMessages(const RobotFrame& frame,
                                           const std::array<CameraCalibration, kCameraCount>& calibrations,
                                           const ros::Time& stamp) {
  std::vector<CameraMessages> cameras;
  if (frame.images[0].empty()) return cameras;
  const std_msgs::Header header = headerOf(frame.robot + "/reference_optical", stamp);
  for (std::size_t i = 0; i < kCameraCount; ++i)
    cameras.push_back({toImage(frame.images[i], sensor_msgs::image_encodings::MONO8, header),
                       toCameraInfo(calibrations[i], header)});
  return cameras;
}

}  // namespace cornerstone
