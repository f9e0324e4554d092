#include "cornerstone/landmarks/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cornerstone {

// Only cells near an edge are ever asked: writing those costs a tenth of a transform of the whole map.
DistanceField::DistanceField(const std::vector<EdgePoint>& edges, const GridGeometry& geometry)
    : distances_(geometry.rows, geometry.cols, static_cast<float>(kReachCells + 1)) {
  std::array<std::array<float, 2 * kReachCells + 1>, 2 * kReachCells + 1> around;
  for (int r = -kReachCells; r <= kReachCells; ++r)
    for (int c = -kReachCells; c <= kReachCells; ++c)
      around[static_cast<std::size_t>(r + kReachCells)][static_cast<std::size_t>(c + kReachCells)] =
          std::hypot(static_cast<float>(c), static_cast<float>(r));
  for (const EdgePoint& edge : edges) {
    const Cell cell = geometry.cellAt(edge.position_m);
    if (!geometry.contains(cell) || distances_(cell.row, cell.col) == 0) continue;
    const int first = std::max(cell.col - kReachCells, 0),
              last = std::min(cell.col + kReachCells, geometry.cols - 1);
    for (int row = std::max(cell.row - kReachCells, 0);
         row <= std::min(cell.row + kReachCells, geometry.rows - 1); ++row) {
      float* to = distances_[row];
      const float* from =
          around[static_cast<std::size_t>(row - cell.row + kReachCells)].data() + kReachCells - cell.col;
      for (int col = first; col <= last; ++col) to[col] = std::min(to[col], from[col]);
    }
  }
}

double DistanceField::at(const Eigen::Vector2d& point_cells) const {
  Eigen::Vector2d gradient;
  return at(point_cells, gradient);
}

double DistanceField::at(const Eigen::Vector2d& point_cells, Eigen::Vector2d& gradient) const {
  const double x = std::clamp(point_cells.x(), 0.0, static_cast<double>(distances_.cols - 1));
  const double y = std::clamp(point_cells.y(), 0.0, static_cast<double>(distances_.rows - 1));
  const int col = std::min(static_cast<int>(x), std::max(distances_.cols - 2, 0));
  const int row = std::min(static_cast<int>(y), std::max(distances_.rows - 2, 0));
  const int right = std::min(col + 1, distances_.cols - 1), up = std::min(row + 1, distances_.rows - 1);
  const double u = x - col, v = y - row;
  const double a = distances_(row, col), b = distances_(row, right);
  const double c = distances_(up, col), d = distances_(up, right);
  gradient.x() = x == point_cells.x() ? (1 - v) * (b - a) + v * (d - c) : 0;
  gradient.y() = y == point_cells.y() ? (1 - u) * (c - a) + u * (d - b) : 0;
  return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
}

}  // namespace cornerstone
