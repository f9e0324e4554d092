// Boundaries between free and occupied space (paper, section 3.1.1), at sub-cell precision.
// Certain regions grow into uncertain cells, never into unseen ones; an edge is an occupied cell beside a
// free one, on the surface that was measured there where the map knows it (surface_edges.h). Positions are
// metres of the map's frame. A map without free or without occupied cells has no edges.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

struct EdgeParams {
  double occupied_above = 0.65;  // probability: certainly occupied, the convention of map_server
  double free_below = 0.196;     // probability: certainly free, the convention of map_server
  double smoothing_m =
      0.15;  // radius in which neighbouring edges fix a line: a wall's cells, less than a door jamb
};
void describe(ParamVisitor& visitor, EdgeParams& params);

struct EdgePoint {
  Eigen::Vector2d position_m;  // of the boundary or the surface, at sub-cell precision
  Eigen::Vector2d normal;      // unit, from occupied to free
};

enum CellState : unsigned char { kUnknownCell = 0, kFreeCell = 1, kOccupiedCell = 2 };

// The state of each cell after growing; rows and columns as in the map.
cv::Mat1b cellStates(const GridMap& map, const EdgeParams& params);

std::vector<EdgePoint> findEdges(const GridMap& map, const cv::Mat1b& states, const EdgeParams& params);

}  // namespace cornerstone
