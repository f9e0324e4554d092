// The best poses of one map in another, judged on both maps, best first and all different.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/registration/pose_score.h"
#include "cornerstone/registration/registration_params.h"

namespace cornerstone {

struct Hypothesis {
  Pose2 reference_from_current;
  PoseScore score;
  double value = 0;  // what agrees less what contradicts, in edges
};

// Two poses are different when they put a point of the current map far apart, or turn it otherwise.
struct PoseDistance {
  Eigen::Vector2d point_in_current_m;
  double distance_m;
  double angle_rad;

  bool apart(const Pose2& a, const Pose2& b) const;
};

// Walks each pose uphill by small steps of a look's score.
void settlePoses(const EvidencePair& maps, std::vector<Hypothesis>& poses, const RegistrationParams& params);

std::vector<Hypothesis> searchPoses(const EvidencePair& maps, const std::vector<Pose2>& proposals,
                                    const RegistrationParams& params);

}  // namespace cornerstone
