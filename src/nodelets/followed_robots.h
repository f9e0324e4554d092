// The maps of this robot and of others as their tiles arrive, what the others tell of their own place, and
// whose turn it is to be compared.
#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cornerstone/MapRegistration.h"
#include "cornerstone/ros/tile_follower.h"

namespace cornerstone {

using MapVersion = std::pair<std::uint32_t, std::uint32_t>;  // epoch, version

struct FollowedRobot {
  TileFollower tiles;
  ros::Subscriber tiles_subscriber;
  ros::Subscriber registration_subscriber;
  MapVersion version() const { return {tiles.epoch(), tiles.version()}; }
};

class FollowedRobots {
 public:
  struct Callbacks {
    // A robot's map is there for the first time, or has begun anew.
    std::function<void(const std::string& robot, bool first)> began;
    std::function<void(const std::string& robot, const MapRegistration&)> told;
    std::function<void(const std::string& cause)> dropped;
  };
  FollowedRobots(const ros::NodeHandle& node, Callbacks callbacks);

  // Robots stand beside one another's namespaces: /b follows /a/map_tiles and /a/registration. It follows its
  // own map_tiles, too, which no registration goes with.
  void follow(const std::string& robot, bool own);

  const FollowedRobot& at(const std::string& robot) const { return robots_.at(robot); }
  // The next robot of `turns` whose map or this robot's has changed since this call named it last.
  std::optional<std::string> nextTurn(const std::string& own, const std::vector<std::string>& turns);
  // Some map has changed since the last call.
  bool changed();
  // A robot's map is of another epoch than at the last call.
  bool isAnew(const std::string& robot);

 private:
  ros::NodeHandle node_;
  Callbacks callbacks_;
  std::map<std::string, FollowedRobot> robots_;
  std::map<std::string, std::pair<MapVersion, MapVersion>> compared_;  // by robot: own version, its version
  std::map<std::string, MapVersion> seen_;                             // by changed()
  std::map<std::string, std::uint32_t> epochs_;                        // by isAnew()
  std::size_t turn_ = 0;
};

}  // namespace cornerstone
