// Poses worth looking at, without any prior: a fitted corner is a full pose, so each pair of corners of the
// same kind proposes one. The directions of the walls are known far better than those of a single corner:
// they correct the yaw.
#pragma once

#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/landmarks/detect_corners.h"

namespace cornerstone {

// How much of a map's walls faces each way, one number a degree.
std::vector<double> wallDirections(const std::vector<EdgePoint>& edges);

// How well the walls' directions of two maps agree for each relative yaw.
class DirectionMatch {
 public:
  DirectionMatch(const std::vector<double>& reference, const std::vector<double>& current);
  // The best yaw within reach of a rough one.
  double nearestPeak(double yaw_rad, double reach_rad) const;
  // Yaws of the highest peaks, best first.
  std::vector<double> peaks(std::size_t count) const;

 private:
  std::vector<double> agreement_;  // by relative yaw, one a degree
};

// reference_from_current of every pair of corners of equal kind, yaw corrected.
std::vector<Pose2> proposeFromCorners(const std::vector<CornerLandmark>& reference,
                                      const std::vector<CornerLandmark>& current,
                                      const DirectionMatch& directions);

// Poses that put the current map's middle within a square and a few degrees of one another become one.
std::vector<Pose2> mergeProposals(const std::vector<Pose2>& poses, const Eigen::Vector2d& middle_m,
                                  double square_m, double angle_rad);

}  // namespace cornerstone
