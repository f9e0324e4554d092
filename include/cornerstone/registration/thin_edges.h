// A map's edges, thinned to one per square and direction: each then stands for one square of wall.
// Metres of the map's frame.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cornerstone/landmarks/edges.h"

namespace cornerstone {

// One edge of a thinned map.
struct EdgeSample {
  Eigen::Vector2f position_m;
  int direction_256 = 0;  // of the normal, in 256ths of a turn
};

// Of a normal, in eighths of a turn, each around its middle.
int directionOf8(const Eigen::Vector2d& normal);

// The edges averaged over squares of square_m and 8 directions, in an order without pattern that is always
// the same: the first n are a fair choice of n.
std::vector<EdgePoint> thinEdges(const std::vector<EdgePoint>& edges, double square_m);
std::vector<EdgeSample> samplesOf(const std::vector<EdgePoint>& edges);

}  // namespace cornerstone
