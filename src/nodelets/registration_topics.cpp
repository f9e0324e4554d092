#include "nodelets/registration_topics.h"

#include "cornerstone/ros/grid_messages.h"

namespace cornerstone {

RegistrationTopics::RegistrationTopics(ros::NodeHandle node, const RegistrationNodeletParams& params,
                                       bool registers)
    : params_(params), shared_frame_id_(registers ? params.reference_map_frame : params.frames.map) {
  landmarks_ = node.advertise<CornerArray>("landmarks", 1, true);
  landmark_markers_ = node.advertise<visualization_msgs::MarkerArray>("landmark_markers", 1, true);
  merged_ = node.advertise<nav_msgs::OccupancyGrid>("merged_map", 1, true);
  if (!registers) return;
  registration_ = node.advertise<MapRegistration>("registration", 1, true);
  match_markers_ = node.advertise<visualization_msgs::MarkerArray>("match_markers", 1, true);
}

void RegistrationTopics::publishLandmarks(const RegistrationFindings& found) const {
  CornerArray message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = params_.frames.map;
  message.robot = params_.robot;
  message.map_epoch = found.job.own.epoch();
  message.version = found.job.own.version();
  const Landmarks& landmarks = found.attempt.landmarks;
  for (const CornerLandmark& corner : landmarks.corners)
    message.corners.push_back(toMessage(corner, message.header.stamp.toSec()));
  landmarks_.publish(message);
  if (landmark_markers_.getNumSubscribers() > 0)
    landmark_markers_.publish(toMarkers(landmarks, params_.landmarks.arm_length_m, message.header));
}

void RegistrationTopics::publishMerged(const GridMap& merged) const {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = shared_frame_id_;
  merged_.publish(toOccupancyGrid(merged, header));
}

void RegistrationTopics::publishRegistration(const SharedFrame& shared, const FollowedRobots& robots) const {
  const ros::Time now = ros::Time::now();
  MapRegistration message = toMessage(shared, now.toSec());
  message.header.stamp = now;
  message.header.frame_id = message.reference_frame = shared_frame_id_;
  message.current_frame = params_.frames.map;
  message.reference_robot = params_.reference_robot;
  message.current_robot = params_.robot;
  message.reference_epoch = robots.at(params_.reference_robot).tiles.epoch();
  message.current_epoch = robots.at(params_.robot).tiles.epoch();
  if (shared.route) addPairs(message);
  registration_.publish(message);
  const bool direct = message.state == MapRegistration::REGISTERED && message.via.empty();
  if (direct && match_markers_.getNumSubscribers() > 0) match_markers_.publish(toMatchMarkers(message));
}

void RegistrationTopics::addPairs(MapRegistration& message) const {
  const auto pairs = pairs_.find(message.via.empty() ? params_.reference_robot : message.via.back());
  if (pairs == pairs_.end()) return;
  for (const auto& [there, here] : pairs->second) {
    message.reference_corners.push_back(toMessage(there, message.header.stamp.toSec()));
    message.current_corners.push_back(toMessage(here, message.header.stamp.toSec()));
  }
}

}  // namespace cornerstone
