// A map's edges, thinned to one per square and direction: each then stands for one square of wall.
// Metres of the map's frame.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cornerstone/landmarks/edges.h"

namespace cornerstone {

// Edges of a thinned map, each figure of all of them in a row: the compiler takes several edges at once.
struct EdgeSamples {
  std::vector<float> x_m, y_m;
  std::vector<int> direction_256;  // of the normal, in 256ths of a turn

  std::size_t size() const { return direction_256.size(); }
  Eigen::Vector2f position_m(std::size_t i) const { return {x_m[i], y_m[i]}; }
  void add(const Eigen::Vector2f& position_m, int direction) {
    x_m.push_back(position_m.x());
    y_m.push_back(position_m.y());
    direction_256.push_back(direction);
  }
};

// Of a normal, in eighths of a turn, each around its middle.
int directionOf8(const Eigen::Vector2d& normal);

// The edges averaged over squares of square_m and 8 directions, in an order without pattern that is always
// the same: the first n are a fair choice of n.
std::vector<EdgePoint> thinEdges(const std::vector<EdgePoint>& edges, double square_m);
EdgeSamples samplesOf(const std::vector<EdgePoint>& edges);

}  // namespace cornerstone
