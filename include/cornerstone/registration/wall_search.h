// Poses worth looking at where corners are too few: for each relative yaw that the walls' directions allow,
// the score of every shift at once, as a correlation (by Fourier transform) of both maps' edges with what the
// other map says there. Metres of the maps' frames; shifts are right to the square's size.
#pragma once

#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/registration/pose_score.h"

namespace cornerstone {

struct WallSearchOptions {
  double square_m = 0.5;       // of the correlated grids: the coarse reach
  int max_size_squares = 512;  // of the transform: larger maps get larger squares
  std::size_t peaks = 20;      // poses for each yaw
  double contradiction = 3;    // weight of an edge on free space against an edge on an edge
};

std::vector<Pose2> proposeFromWalls(const EvidencePair& maps, const std::vector<double>& yaws,
                                    const WallSearchOptions& options);

}  // namespace cornerstone
