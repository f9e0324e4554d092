// How this robot's map hangs together with those of the others: a link (a tracked registration) to each robot
// that it follows, what those robots tell of their own place in the reference map, and from both the one
// frame to share. It never guesses: without REGISTERED there is no pose. No ROS.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cornerstone/registration/frame_route.h"
#include "cornerstone/registration/registration_tracker.h"

namespace cornerstone {

// What another robot tells of its own map: its route to the reference map, and of which maps.
struct ToldRoute {
  FrameRoute route;
  std::uint32_t robot_epoch = 0;
  std::uint32_t reference_epoch = 0;
};

// What is to be published.
struct SharedFrame {
  RegistrationState state = RegistrationState::kNone;
  std::string reason;               // why not REGISTERED
  std::optional<FrameRoute> route;  // while REGISTERED, and the direct candidate while CANDIDATE
  // The evidence of this robot's own link in the route.
  std::optional<Registration> evidence;
};

class RobotLinks {
 public:
  // self, reference: names of robots; others: those that may stand in between.
  RobotLinks(std::string self, std::string reference, const std::vector<std::string>& others,
             const TrackerParams& params);

  // The outcome of one attempt to register this robot's map in that of `robot`; see
  // RegistrationTracker::update.
  bool update(const std::string& robot, const std::optional<Registration>& answer,
              const Eigen::Vector2d& centre_m, double time_s);
  // The map of `robot` has begun anew (or is seen for the first time) in this epoch.
  void beginAnew(const std::string& robot, std::uint32_t epoch);
  // This robot's own map began anew.
  void beginAnew(const std::string& reason);
  // What `robot` tells of itself; empty: it is not registered. Routes that run through this robot do not
  // count: two robots must not hold each other up.
  void hear(const std::string& robot, const std::optional<ToldRoute>& told);

  // Where `robot`'s map lies in the reference map, as far as it tells; the reference robot's own: identity.
  std::optional<FrameRoute> routeOf(const std::string& robot) const;
  const RegistrationTracker& tracker(const std::string& robot) const { return links_.at(robot).tracker; }
  // A rough reference_from_current for attempts with `robot`: its link where registered, or what the shared
  // frame and the robot's own route make of it.
  std::optional<Pose2> priorFor(const std::string& robot, const SharedFrame& shared) const;

  // centre_m: where the routes are compared, in this robot's map.
  SharedFrame shared(const Eigen::Vector2d& centre_m, double time_s);

 private:
  struct Link {
    RegistrationTracker tracker;
    std::optional<ToldRoute> told;
    std::optional<std::uint32_t> epoch;  // of the robot's map
  };
  std::vector<FrameRoute> routesAt(double time_s) const;
  SharedFrame withoutRoute(const std::string& refusal, double time_s) const;

  std::string self_;
  std::string reference_;
  TrackerParams params_;
  std::map<std::string, Link> links_;
  bool was_registered_ = false;
};

}  // namespace cornerstone
