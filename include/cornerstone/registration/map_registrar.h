// Attempts to register one robot's map in those of others, again and again as all grow. What an attempt
// learns of a map is kept for the next one: landmarks are looked for only where the map changed. No ROS, no
// clock of its own, one attempt at a time: it may run in a thread of its own.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cornerstone/landmarks/landmark_follower.h"
#include "cornerstone/registration/register_maps.h"

namespace cornerstone {

struct RegistrationTask {
  std::optional<GridMap> reference;  // empty: only landmarks of the current map are wanted
  GridMap current;
  RegistrationHints hints;
  double time_s = 0;
  std::string reference_robot;  // whose map the reference is: what is known of it is kept under this name
  bool reference_anew = false;  // the map began anew: nothing known of the old one holds
  bool current_anew = false;
  std::vector<Eigen::Vector2d> reference_way_m = {}, current_way_m = {};  // of the robots; empty: not known
};

struct RegistrationAttempt {
  Landmarks landmarks;  // of the current map
  RegistrationOutcome outcome;
  std::vector<std::pair<CornerLandmark, CornerLandmark>>
      pairs;  // of the answer: in the reference, in the current
};

class MapRegistrar {
 public:
  MapRegistrar(const LandmarkParams& landmarks, const RegistrationParams& registration);

  // Near the prior first. Where that no longer holds, the maps may say where the truth lies.
  RegistrationAttempt attempt(const RegistrationTask& task);

 private:
  struct MapNews {
    const GridMap& map;
    const std::vector<Eigen::Vector2d>& way_m;
    double time_s;
  };
  // What is known of one robot's map.
  struct Side {
    LandmarkFollower follower;
    std::optional<MapEvidence> evidence;

    void update(const MapNews& news, const RegistrationParams& params);
    PreparedMap prepared() const { return {follower.landmarks(), *evidence}; }
  };
  RegistrationOutcome registerIn(const Side& reference, const RegistrationHints& hints) const;

  LandmarkParams landmark_params_;
  RegistrationParams params_;
  std::map<std::string, Side> references_;  // by robot
  Side current_;
};

}  // namespace cornerstone
