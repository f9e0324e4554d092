// What a map is worth against the world it shows. Occupied: above 0.65. Map cells are placed in the world by
// `world_from_map` alone.
#pragma once

#include <vector>

#include "cornerstone/mapping/grid_map.h"
#include "cornerstone/simulation/true_surfaces.h"

namespace cornerstone::bench {

struct MapWorth {
  double precision = 0;      // of the occupied cells: within 0.10 m of a true surface
  double recall = 0;         // of the surfaces seen within 3 m of the way: an occupied cell within 0.10 m
  double phantom_share = 0;  // of the cells told about that are truly free: occupied
  double sharpness_m = 0;    // median distance of occupied cells from true surfaces, within 3 m of the way
};

class MapTruth {
 public:
  MapTruth(const World& world, const std::vector<Pose2>& world_from_bases);
  MapWorth worthOf(const GridMap& map, const Pose2& world_from_map) const;

 private:
  bool inside(const Eigen::Vector2d& point_m) const;  // of a solid
  bool nearWay(const Eigen::Vector2d& point_m) const;

  std::vector<Solid> solids_;
  TrueSurfaces surfaces_;
  std::vector<Eigen::Vector2d> way_m_;
  std::vector<Eigen::Vector2d> seen_m_;  // points of surfaces
};

}  // namespace cornerstone::bench
