// How many free and occupied cells of a map fall into each square of a coarser grid. Metres of the map's
// frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/grid_geometry.h"

namespace cornerstone {

struct SquareCounts {
  Eigen::Vector2f origin_m{0, 0};
  double square_m = 1;
  int cols = 0;
  int rows = 0;
  double cells_per_square = 1;  // as areas
  std::vector<std::uint16_t> free;
  std::vector<std::uint16_t> occupied;

  bool known(const Eigen::Vector2f& point_m) const;
  std::vector<Eigen::Vector2f> knownSquares() const;  // their middles
};

// states: of the cells (CellState).
SquareCounts countSquares(const GridGeometry& geometry, const cv::Mat1b& states, double square_m);

// The same in larger squares: each square goes to the one that holds its middle.
SquareCounts inLargerSquares(const SquareCounts& counts, double square_m);

}  // namespace cornerstone
