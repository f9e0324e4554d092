// Where a robot stands when its wheels have slipped, or somebody pushed it: the pose at which a scan lies on
// the map, sought around where odometry puts it.
//
// Coarse to fine: beam ends are counted on squares that lie near a surface of the map and on squares that are
// surely free; the best different poses are sought again in smaller steps, the rest is a scan fit
// (scan_fit.h). A pose is an answer only if nearly all of the scan agrees with the map there, more than at
// odometry's pose, the fit leaves no direction open, and no different pose does nearly as well: in a round
// room, before a single wall, along a bare corridor, or where the world has changed, there is none.
#pragma once

#include <optional>

#include "cornerstone/mapping/scan_fit.h"

namespace cornerstone {

// For sensors that see half a turn or more. A camera sees a quarter of a room, which lies nearly as well on
// many places, and its errors are taken for slips: both searches are off by default (mapper_laser.yaml has
// them).
struct RelocalisationParams {
  // When to search: where scan and odometry differ by more than this in their common sigmas, or where of the
  // ends that the map knows anything of fewer than this share agree with it.
  double slip_sigmas = 5;
  double doubtful_share = 0.8;
  double slip_reach_m = 0;  // around odometry's pose, first; 0: none
  double slip_reach_rad = 15 * M_PI / 180;
  double reach_m = 0;               // of the search at every heading; 0: none
  double min_agreeing_share = 0.7;  // of the beam ends: on a surface, less those on free floor
  // The same at every heading: turned by half a turn many places look nearly the same (0.73 in a real
  // crossing).
  double min_agreeing_share_far = 0.85;
  // A different pose (half a metre or 15 degrees away) that agrees by more than this share of the best one's:
  // no answer.
  double max_rival_share = 0.8;
};
void describe(ParamVisitor& visitor, RelocalisationParams& params);
void requireValid(const RelocalisationParams& params);  // throws InputError naming the parameter

struct LookOnMap {
  const RangeScan& scan;
  const OccupancyGrid& grid;
};

struct SearchWindow {
  Pose2 map_from_base;  // its middle: where odometry puts the robot
  double reach_m = 0;
  double reach_rad = M_PI;
  // Of the ends: where the map knows fewer, those missing count against a pose, and against odometry's.
  double min_known_share = 1, min_known_share_here = 1;
};

struct Relocalisation {
  bool elsewhere = false;            // the scan fits well at another pose than odometry's, perhaps at several
  bool here = false;                 // it fits nowhere better than at odometry's pose
  std::optional<PoseEstimate> pose;  // map_from_base by the scan fit, where the scan singles another one out
  double agreeing = 0;               // of the ends, at the best pose
};
Relocalisation relocalise(const LookOnMap& look, const SearchWindow& window, const ScanFitParams& fit,
                          const RelocalisationParams& params);

}  // namespace cornerstone
