// Localization by corners when a rough pose is known (paper, section 4): each corner is paired with the
// nearest one of the other map, and least squares over the pairs gives the transform. Poses are
// reference_from_current, in metres.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/landmarks/corner.h"

namespace cornerstone {

using CornerPairs = std::vector<std::pair<int, int>>;  // indices (reference corner, current corner)

struct PairingLimits {
  double distance_m = 1.0;  // paper, section 4.1: farther corners stay unmatched
  double angle_rad =
      0.35;  // and yaws this far apart are another corner: the paper's 15 degrees and a corner's own
};

// Pairs of equal kind that are each other's nearest under a pose.
CornerPairs pairNearest(const std::vector<CornerLandmark>& reference,
                        const std::vector<CornerLandmark>& current, const Pose2& pose,
                        const PairingLimits& limits);

// The pose that brings the pairs' apexes together, each pair weighted by its covariances (paper,
// section 4.2). No answer for fewer than two pairs: one apex leaves the yaw open.
std::optional<Pose2> solvePairs(const std::vector<CornerLandmark>& reference,
                                const std::vector<CornerLandmark>& current, const CornerPairs& pairs,
                                const Pose2& guess);

}  // namespace cornerstone
