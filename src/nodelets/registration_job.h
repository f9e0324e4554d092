// One look at the maps, run in a thread of its own: landmarks, a comparison with another robot's map, the
// merged map. It works on copies, and on the registrar, which nobody else uses meanwhile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cornerstone/registration/map_registrar.h"
#include "cornerstone/registration/merge_maps.h"
#include "cornerstone/ros/tile_follower.h"

namespace cornerstone {

struct PlacedTiles {
  TileFollower tiles;
  Pose2 reference_from_map;
};

struct RegistrationJob {
  std::string robot;  // that this robot's map is compared with; empty: only landmarks are wanted
  TileFollower own, other;
  RegistrationTask task;  // its maps are put together from the tiles by the job
  std::optional<TileFollower> merge_into;
  std::vector<PlacedTiles> merge;
};

struct RegistrationFindings {
  RegistrationJob job;
  RegistrationAttempt attempt;
  std::optional<GridMap> merged;
  Eigen::Vector2d centre_m;  // of the own map: where the robot is, or the middle
  double elapsed_s = 0;
};

RegistrationFindings run(RegistrationJob job, MapRegistrar& registrar);

}  // namespace cornerstone
