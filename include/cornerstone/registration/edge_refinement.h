// Refines a pose on the edges of both maps: each edge is drawn to the line through the nearest edge of the
// other map that faces the same way, with a robust loss, and partners are chosen anew as the pose improves.
// Solved with Ceres. No answer where fewer than ten partners are found.
#pragma once

#include <optional>

#include "cornerstone/base/pose2.h"
#include "cornerstone/landmarks/edge_index.h"

namespace cornerstone {

struct RefinementOptions {
  double first_reach_m = 0.3;    // search radius at the start
  double last_reach_m = 0.1;     // and at the end
  double cell_m = 0.05;          // of the coarser map: its walls are right to a part of it
  int rounds = 5;                // of choosing partners
  std::size_t max_edges = 2000;  // of each map, evenly chosen: millimetres need no more
  std::optional<Eigen::Vector2d> focus_in_current_m;  // edges near it weigh most, as a Gaussian; empty: alike
  double focus_radius_m = 4;                          // its standard deviation
  double min_spread = 0.05;  // of the edges around the focus: with less the whole map decides
};

struct RefinedPose {
  Pose2 reference_from_current;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // (x, y, yaw) of the pose, m and rad
  double rms_m = 0;
  int partners = 0;
  double spread = 0;  // weakest over strongest translation direction of the information: 0 on an open axis
};

std::optional<RefinedPose> refineOnEdges(const EdgeIndex& reference, const EdgeIndex& current,
                                         const Pose2& guess, const RefinementOptions& options);

}  // namespace cornerstone
