// What a map says to an edge of another map that a pose lays on it, as a table over squares and directions:
// 100 where an edge of the same direction lies, falling to 0 at the reach; -100 where space is surely free
// and no edge is near; 0 where the map knows nothing. Metres of the map's frame. A map without edges gives a
// grid in which nothing agrees.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cornerstone/landmarks/edges.h"
#include "cornerstone/registration/square_counts.h"

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
  // counts: of the map's cells, in the squares of this grid.
  EvidenceGrid(SquareCounts counts, const std::vector<EdgePoint>& edges, double reach_m);

  // direction: of the edge's normal, in 256ths of a turn.
  int at(const Eigen::Vector2f& point_m, int direction_256) const {
    const Eigen::Vector2f square = (point_m - counts_.origin_m) * per_square_;
    return atSquare(square.x(), square.y(), direction_256);
  }
  // The same by coordinates in squares from the grid's origin.
  int atSquare(float x, float y, int direction_256) const {
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(counts_.cols) && y < static_cast<float>(counts_.rows)))
      return 0;
    const int index = static_cast<int>(y) * counts_.cols + static_cast<int>(x);
    const int direction = ((direction_256 + 16) & 255) >> 5;
    return table_[static_cast<std::size_t>(index * kEvidenceDirections + direction)] - kFullEvidence;
  }
  const Eigen::Vector2f& origin() const { return counts_.origin_m; }
  float squaresPerMetre() const { return per_square_; }
  const SquareCounts& counts() const { return counts_; }
  bool known(const Eigen::Vector2f& point_m) const { return counts_.known(point_m); }
  double squareSize() const { return counts_.square_m; }
  // Of all squares that say something.
  std::vector<Opinion> opinions() const;
  // Middles of the known squares.
  std::vector<Eigen::Vector2f> knownSquares() const { return counts_.knownSquares(); }

 private:
  void markFree();
  void addEdges(const std::vector<EdgePoint>& edges, float reach_squares);

  SquareCounts counts_;
  float per_square_;
  std::vector<std::uint8_t> table_;  // evidence + 100, 8 directions a square
};

}  // namespace cornerstone
