#include "cornerstone/landmarks/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cornerstone {
namespace {

static_assert((kReachCells + 1) * kDistanceUnits < 256, "distances fit a byte");
constexpr int kSquare = 2 * kReachCells + 1;
constexpr double kInside = 1e-3;  // of a cell
constexpr int kPitch = 16;        // of a row of the stamp: a register's bytes

// Distances around an edge, row by row.
std::array<unsigned char, kSquare * kPitch> distanceStamp() {
  std::array<unsigned char, kSquare * kPitch> stamp{};
  for (int row = 0; row < kSquare; ++row)
    for (int col = 0; col < kSquare; ++col)
      stamp[static_cast<std::size_t>(row * kPitch + col)] = static_cast<unsigned char>(
          std::min(std::lround(kDistanceUnits * std::hypot(col - kReachCells, row - kReachCells)),
                   static_cast<long>((kReachCells + 1) * kDistanceUnits)));
  return stamp;
}

}  // namespace

// Only cells near an edge are ever asked: writing those costs a tenth of a transform of the whole map.
DistanceField::DistanceField(const std::vector<EdgePoint>& edges, const GridGeometry& geometry)
    : distances_(geometry.rows, geometry.cols,
                 static_cast<unsigned char>((kReachCells + 1) * kDistanceUnits)) {
  std::vector<Cell> cells;
  for (const EdgePoint& edge : edges) {
    // Many edges lie on the border between two cells, to the last digit: they count to the upper one.
    const Cell cell =
        geometry.cellAt(edge.position_m + Eigen::Vector2d::Constant(kInside * geometry.resolution_m));
    if (!geometry.contains(cell) || isEdge(cell.col, cell.row)) continue;
    distances_(cell.row, cell.col) = 0;
    cells.push_back(cell);
  }
  const auto stamp = distanceStamp();
  for (const Cell cell : cells) {
    // Beyond a neighbour that is an edge, too, that one is nearer: along a wall little is left to write.
    const int left = isEdge(cell.col - 1, cell.row) ? cell.col : std::max(cell.col - kReachCells, 0);
    const int right =
        isEdge(cell.col + 1, cell.row) ? cell.col : std::min(cell.col + kReachCells, geometry.cols - 1);
    const int bottom = isEdge(cell.col, cell.row - 1) ? cell.row : std::max(cell.row - kReachCells, 0);
    const int top =
        isEdge(cell.col, cell.row + 1) ? cell.row : std::min(cell.row + kReachCells, geometry.rows - 1);
    for (int row = bottom; row <= top; ++row) {
      unsigned char* to = distances_[row] + left;
      const unsigned char* from = &stamp[static_cast<std::size_t>((row - cell.row + kReachCells) * kPitch +
                                                                  left - cell.col + kReachCells)];
      if (right - left == kSquare - 1)  // a length known beforehand lets the compiler take the row at once
        for (int i = 0; i < kSquare; ++i) to[i] = std::min(to[i], from[i]);
      else
        for (int i = 0; i <= right - left; ++i) to[i] = std::min(to[i], from[i]);
    }
  }
}

bool DistanceField::isEdge(int col, int row) const {
  return col >= 0 && row >= 0 && col < distances_.cols && row < distances_.rows && distances_(row, col) == 0;
}

double DistanceField::at(const Eigen::Vector2d& point_cells) const {
  Eigen::Vector2d gradient;
  return at(point_cells, gradient);
}

double DistanceField::atBorder(const Eigen::Vector2d& point_cells, Eigen::Vector2d& gradient) const {
  const Eigen::Vector2d last(distances_.cols - 1, distances_.rows - 1);
  const Eigen::Vector2d inside = point_cells.cwiseMax(0).cwiseMin(last);
  const int col = std::min(static_cast<int>(inside.x()), std::max(distances_.cols - 2, 0));
  const int row = std::min(static_cast<int>(inside.y()), std::max(distances_.rows - 2, 0));
  const int right = std::min(col + 1, distances_.cols - 1), up = std::min(row + 1, distances_.rows - 1);
  const double value =
      interpolate({distances_(row, col), distances_(row, right), distances_(up, col), distances_(up, right)},
                  inside - Eigen::Vector2d(col, row), gradient);
  if (inside.x() != point_cells.x()) gradient.x() = 0;
  if (inside.y() != point_cells.y()) gradient.y() = 0;
  return value;
}

}  // namespace cornerstone
