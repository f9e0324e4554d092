// How well a pose is known that was fitted to pairs of edges. Edges err together, not one by one, so that
// independent evidence is counted, not edges:
// - neighbouring edges share what moved their wall: how much the sums J'r over squares of some metres scatter
//   says how many edges count as one (the design effect of clustered samples); the slope of the robust loss,
//   not its weights, is their information;
// - a wall along a grid's axis is off by the same part of a cell over its whole length, in either map. The
//   residuals do not show that when both maps are turned alike. A wall at an angle meets every part of a cell
//   in turn, and is off by what is left of one turn.
// What is common to all of a map, such as the drift of the log that made it, no pair of edges can show.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cornerstone/registration/line_cost.h"

namespace cornerstone {

struct FittedPairs {
  const std::vector<LinePair>& pairs;  // with the weights of the fit
  Eigen::Vector3d x;                   // what was fitted: the pivot in the reference map, and the yaw
  double scale_m = 0.01;               // of the Cauchy loss
  double cell_m = 0.05;                // of the coarser map
};

struct FitQuality {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of x, m and rad
  double rms_m = 0;
  double spread = 0;  // weakest over strongest translation direction of the information
};

FitQuality judgeFit(const FittedPairs& fitted);

}  // namespace cornerstone
