// How well a pose agrees with both maps when each neighbourhood of some metres may give way a little: maps
// bend over a building, so that no rigid pose fits everywhere, while a wrong pose lays whole walls on free
// space and stays wrong. Counted as in pose_score.h, on the fine grids.
#pragma once

#include "cornerstone/registration/pose_score.h"

namespace cornerstone {

struct ElasticOptions {
  double tile_m = 6;               // of a neighbourhood: a room and its walls
  double step_m = 0.2;             // first step of a neighbourhood's search, then half of it
  double play_m = 0.4;             // farthest shift: what tablet maps of a floor bend by
  std::size_t max_samples = 3000;  // of each map
};

PoseScore scoreElastic(const MapEvidence& reference, const MapEvidence& current,
                       const Pose2& reference_from_current, const ElasticOptions& options);

}  // namespace cornerstone
