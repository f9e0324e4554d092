// The best poses of one map in another, judged on both maps, best first and all different.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/landmarks/edge_index.h"
#include "cornerstone/registration/pose_score.h"
#include "cornerstone/registration/registration_params.h"

namespace cornerstone {

struct Hypothesis {
  Pose2 reference_from_current;
  PoseScore score;
  double value = 0;  // what agrees less what contradicts, in edges
};

// Two poses are different when the current map's middle lies elsewhere or is turned.
bool areDifferent(const Pose2& a, const Pose2& b, const Eigen::Vector2d& middle_m, double distance_m,
                  double angle_rad);

Hypothesis judgePose(const MapEvidence& reference, const MapEvidence& current, const Pose2& pose,
                     ScoreLevel level, std::size_t max_samples, double contradiction);

std::vector<Hypothesis> searchPoses(const MapEvidence& reference, const MapEvidence& current,
                                    const std::vector<Pose2>& proposals, const RegistrationParams& params);

}  // namespace cornerstone
