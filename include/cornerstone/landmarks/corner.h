// The landmark of the paper: two segments of fixed length at 90 degrees (section 3.3).
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "cornerstone/base/pose2.h"

namespace cornerstone {

enum class CornerKind {
  kInsideFree,   // a room's corner: the quadrant between the arms is free
  kInsideSolid,  // a pillar or wall end: the quadrant between the arms is solid
};

struct CornerLandmark {
  // map_from_corner: apex at (x, y); one arm runs along +x of the corner's frame, the other along +y.
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // (x, y, yaw), m and rad
  double rms_m = 0;                                      // model points to the nearest edge
  CornerKind kind = CornerKind::kInsideFree;
  // Who it is while the map improves (landmark_follower.h); a single detection leaves these as they are.
  std::uint32_t id = 0;     // 0: nobody followed it
  std::uint32_t looks = 1;  // times it was found, in maps that changed around it
  double since_s = 0;       // when it was found first, by the follower's clock
};

}  // namespace cornerstone
