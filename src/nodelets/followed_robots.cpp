#include "nodelets/followed_robots.h"

#include "cornerstone/base/errors.h"

namespace cornerstone {

FollowedRobots::FollowedRobots(const ros::NodeHandle& node, Callbacks callbacks)
    : node_(node), callbacks_(std::move(callbacks)) {}

void FollowedRobots::follow(const std::string& robot, bool own) {
  FollowedRobot& followed = robots_[robot];
  const std::string beside = ros::names::append(ros::names::parentNamespace(node_.getNamespace()), robot);
  const std::string tiles_topic =
      own ? node_.resolveName("map_tiles") : ros::names::append(beside, "map_tiles");
  followed.tiles_subscriber = node_.subscribe<MapTiles>(
      tiles_topic, 100, [this, robot, tiles_topic, &followed](const MapTilesConstPtr& tiles) {
        try {
          const bool first = followed.tiles.empty();
          if (followed.tiles.take(*tiles) || first) callbacks_.began(robot, first);
        } catch (const InputError& error) {
          callbacks_.dropped(tiles_topic + ": " + error.what());
        }
      });
  if (own) return;
  followed.registration_subscriber = node_.subscribe<MapRegistration>(
      ros::names::append(beside, "registration"), 1,
      [this, robot](const MapRegistrationConstPtr& message) { callbacks_.told(robot, *message); });
}

std::optional<std::string> FollowedRobots::nextTurn(const std::string& own,
                                                    const std::vector<std::string>& turns) {
  const FollowedRobot& self = at(own);
  if (self.tiles.empty()) return std::nullopt;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const std::string& robot = turns[(turn_ + i) % turns.size()];
    const FollowedRobot& other = at(robot);
    if (other.tiles.empty()) continue;
    const std::pair<MapVersion, MapVersion> versions{self.version(), other.version()};
    const auto compared = compared_.find(robot);
    if (compared != compared_.end() && compared->second == versions) continue;
    compared_[robot] = versions;
    turn_ = (turn_ + i + 1) % turns.size();
    return robot;
  }
  return std::nullopt;
}

bool FollowedRobots::changed() {
  bool changed = false;
  for (const auto& [robot, followed] : robots_) {
    if (followed.tiles.empty()) continue;
    const auto [seen, first] = seen_.try_emplace(robot, followed.version());
    changed = changed || first || seen->second != followed.version();
    seen->second = followed.version();
  }
  return changed;
}

bool FollowedRobots::isAnew(const std::string& robot) {
  const std::uint32_t epoch = at(robot).tiles.epoch();
  const auto [known, first] = epochs_.try_emplace(robot, epoch);
  const bool anew = !first && known->second != epoch;
  known->second = epoch;
  return anew;
}

}  // namespace cornerstone
