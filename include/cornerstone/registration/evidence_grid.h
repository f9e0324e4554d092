// What a map says to an edge of another map that a pose lays on it, as a table over squares and directions:
// 100 where an edge of the same direction lies, falling to 0 at the reach; -100 where space is surely free
// and no edge is near; 0 where the map knows nothing. Metres of the map's frame. A map without edges gives a
// grid in which nothing agrees.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "cornerstone/landmarks/edges.h"
#include "cornerstone/registration/square_counts.h"
#include "cornerstone/registration/thin_edges.h"

namespace cornerstone {

constexpr int kEvidenceDirections = 8;
constexpr int kFullEvidence = 100;

// What a square says to the edge that suits it best.
struct Opinion {
  Eigen::Vector2f centre_m;
  int evidence = 0;
};

// Sums over edges laid on a grid.
struct EvidenceSum {
  int agree = 0;       // of what agrees
  int contradict = 0;  // of what contradicts, negative
  int both() const { return agree + contradict; }
};

class EvidenceGrid {
 public:
  // counts: of the map's cells, in the squares of this grid.
  EvidenceGrid(SquareCounts counts, const std::vector<EdgePoint>& edges, double reach_m);

  // direction: of the edge's normal, in 256ths of a turn.
  int at(const Eigen::Vector2f& point_m, int direction_256) const {
    const Eigen::Vector2f square = (point_m - counts_.origin_m) * per_square_;
    return table_[entryAt(square.x(), square.y(), direction_256)] - kFullEvidence;
  }
  // Of the first samples. squareOf: where a sample lies, in squares from the grid's origin; turn_256: what
  // its direction turns by.
  template <typename SquareOf>
  EvidenceSum sum(const EdgeSamples& samples, std::size_t count, int turn_256,
                  const SquareOf& squareOf) const {
    // The places of many samples are found before any is looked up: that the compiler does several at once.
    std::array<std::uint32_t, 64> entries;
    EvidenceSum sum;
    int both = 0;
    for (std::size_t first = 0; first < count; first += entries.size()) {
      const std::size_t block = std::min(count - first, entries.size());
      const float *x_m = &samples.x_m[first], *y_m = &samples.y_m[first];
      const int* direction_256 = &samples.direction_256[first];
      for (std::size_t i = 0; i < block; ++i) {
        const auto [x, y] = squareOf(x_m[i], y_m[i]);
        entries[i] = entryAt(x, y, direction_256[i] + turn_256);
      }
      for (std::size_t i = 0; i < block; ++i) {
        const int evidence = table_[entries[i]] - kFullEvidence;
        sum.agree += std::max(evidence, 0);
        both += evidence;
      }
    }
    sum.contradict = both - sum.agree;
    return sum;
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
  // A point outside leads to the last square, which says nothing. No branches: which points are outside is
  // hard to foretell.
  std::uint32_t entryAt(float x, float y, int direction_256) const {
    const bool inside =
        (x >= 0) & (y >= 0) & (x < static_cast<float>(counts_.cols)) & (y < static_cast<float>(counts_.rows));
    const int col = static_cast<int>(inside ? x : 0), row = static_cast<int>(inside ? y : 0);
    const int square = inside ? row * counts_.cols + col : counts_.rows * counts_.cols;
    return static_cast<std::uint32_t>(square * kEvidenceDirections + (((direction_256 + 16) & 255) >> 5));
  }
  void markFree();
  void addEdges(const std::vector<EdgePoint>& edges, float reach_squares);

  SquareCounts counts_;
  float per_square_;
  // Evidence + 100, 8 directions a square; after the last square one more that says nothing.
  std::vector<std::uint8_t> table_;
};

}  // namespace cornerstone
