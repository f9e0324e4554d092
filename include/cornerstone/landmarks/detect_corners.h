// Corners of a grid map (paper, section 3): edges, candidates, least-squares fit, suppression of near doubles.
#pragma once

#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/landmarks/corner.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

struct LandmarkParams {
  double arm_length_m = 0.5;  // paper: 500 mm
  // (the owner of this area adds the rest, each with unit and reason)
};
void describe(ParamVisitor& visitor, LandmarkParams& params);

struct EdgePoint {
  Eigen::Vector2d position_m;  // between the occupied and the free cell, at sub-cell precision
  Eigen::Vector2d normal;      // unit, from occupied to free
};

struct Landmarks {
  std::vector<EdgePoint> edges;
  std::vector<Corner> corners;
};

Landmarks detectLandmarks(const GridMap& map, const LandmarkParams& params);

}  // namespace cornerstone
