// What the Registration nodelet publishes, each only as far as somebody listens.
#pragma once

#include <ros/ros.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cornerstone/registration/robot_links.h"
#include "cornerstone/ros/landmark_messages.h"
#include "cornerstone/ros/nodelet_params.h"
#include "nodelets/followed_robots.h"
#include "nodelets/registration_job.h"

namespace cornerstone {

class RegistrationTopics {
 public:
  RegistrationTopics(ros::NodeHandle node, const RegistrationNodeletParams& params, bool registers);

  bool mergedIsWanted() const { return merged_.getNumSubscribers() > 0; }
  void publishLandmarks(const RegistrationFindings& found) const;
  void publishMerged(const GridMap& merged) const;
  // Only where the nodelet registers.
  void publishRegistration(const SharedFrame& shared, const FollowedRobots& robots) const;
  // The corner pairs of the newest answer that the link to `robot` rests on.
  void keepPairs(const std::string& robot, const RegistrationAttempt& attempt) {
    pairs_[robot] = attempt.pairs;
  }

 private:
  void addPairs(MapRegistration& message) const;

  const RegistrationNodeletParams& params_;
  ros::Publisher landmarks_, landmark_markers_, merged_, registration_, match_markers_;
  std::string shared_frame_id_;
  std::map<std::string, std::vector<std::pair<CornerLandmark, CornerLandmark>>> pairs_;  // by robot
};

}  // namespace cornerstone
