// What a map says to an edge of another map that a pose lays on it, as a table over squares and directions:
// 100 where an edge of the same direction lies, falling to 0 at the reach; negative where space is surely
// free and no edge is near; 0 where the map knows nothing. Also the map's own edges, thinned to one per
// square and direction. Metres of the map's frame. A map without edges gives an empty grid that says 0
// everywhere.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cornerstone/landmarks/edges.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

constexpr int kEvidenceDirections = 8;
constexpr int kFullEvidence = 100;

// What a square says to the edge that suits it best.
struct Opinion {
  Eigen::Vector2f centre_m;
  int evidence = 0;
};

class EvidenceGrid {
 public:
  // states: of the map's cells (cellStates).
  EvidenceGrid(const GridMap& map, const cv::Mat1b& states, const std::vector<EdgePoint>& edges,
               double cell_m, double reach_m);

  // direction: of the edge's normal, in 256ths of a turn.
  int at(const Eigen::Vector2f& point_m, int direction_256) const {
    const float x = (point_m.x() - origin_m_.x()) * per_cell_, y = (point_m.y() - origin_m_.y()) * per_cell_;
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(cols_) && y < static_cast<float>(rows_))) return 0;
    const int cell = static_cast<int>(y) * cols_ + static_cast<int>(x);
    return table_[static_cast<std::size_t>(cell * kEvidenceDirections + (((direction_256 + 16) & 255) >> 5))];
  }
  bool known(const Eigen::Vector2f& point_m) const;
  double cellSize() const { return 1.0 / per_cell_; }
  // Of all squares that say something.
  std::vector<Opinion> opinions() const;
  // Middles of the known squares.
  std::vector<Eigen::Vector2f> knownSquares() const;

 private:
  void markFree(const GridMap& map, const cv::Mat1b& states);
  void addEdge(const EdgePoint& edge, float reach_cells);

  Eigen::Vector2f origin_m_;
  float per_cell_;
  int cols_;
  int rows_;
  std::vector<std::int8_t> table_;   // 8 directions a square
  std::vector<std::uint8_t> known_;  // per square: cells of known state, up to 255
};

// One edge of a thinned map.
struct EdgeSample {
  Eigen::Vector2f position_m;
  int direction_256 = 0;  // of the normal, in 256ths of a turn
};

// The edges averaged over squares of cell_m and 8 directions, in an order without pattern that is always the
// same: the first n are a fair choice of n.
std::vector<EdgePoint> thinEdges(const std::vector<EdgePoint>& edges, double cell_m);
std::vector<EdgeSample> samplesOf(const std::vector<EdgePoint>& edges);

}  // namespace cornerstone
