#include "surface_lines.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cornerstone {

SurfaceLines::SurfaceLines(const OccupancyGrid& grid, const Eigen::Vector2d& low_m,
                           const Eigen::Vector2d& high_m, double line_radius_m)
    : window_(grid.readWindow(low_m, high_m)),
      surface_(grid.readSurface(window_)),
      line_radius_m_(line_radius_m),
      line_of_cell_(surface_.size(), -1) {}

std::optional<Cell> SurfaceLines::nearestCell(const Eigen::Vector2d& point_m, double gate_m) const {
  const GridGeometry& at = window_.geometry;
  const Cell centre = at.cellAt(point_m);
  const int reach = static_cast<int>(std::ceil(gate_m / at.resolution_m));
  double best_m2 = gate_m * gate_m;
  Cell best{-1, -1};
  for (int row = std::max(0, centre.row - reach); row <= std::min(at.rows - 1, centre.row + reach); ++row)
    for (int col = std::max(0, centre.col - reach); col <= std::min(at.cols - 1, centre.col + reach); ++col) {
      const SurfacePoint& candidate = surface_[window_.indexOf({col, row})];
      if (candidate.weight <= 0) continue;
      const double away_m2 = std::pow(static_cast<double>(candidate.x_m) - point_m.x(), 2) +
                             std::pow(static_cast<double>(candidate.y_m) - point_m.y(), 2);
      if (away_m2 >= best_m2) continue;
      best_m2 = away_m2;
      best = {col, row};
    }
  if (best.col < 0) return std::nullopt;
  return best;
}

std::optional<SurfaceLine> SurfaceLines::nearest(const Eigen::Vector2d& point_m, double gate_m) const {
  const std::optional<Cell> cell = nearestCell(point_m, gate_m);
  if (!cell) return std::nullopt;
  int& line = line_of_cell_[window_.indexOf(*cell)];
  if (line < 0) {
    line = static_cast<int>(lines_.size());
    lines_.push_back(lineAround(*cell));
  }
  return lines_[static_cast<std::size_t>(line)];
}

bool SurfaceLines::isFree(const Eigen::Vector2d& point_m, double gate_m) const {
  const Cell cell = window_.geometry.cellAt(point_m);
  return window_.geometry.contains(cell) && EvidenceScale::logOddsOf(window_.at(cell)) < 0 &&
         !nearestCell(point_m, gate_m);
}

std::optional<SurfaceLine> SurfaceLines::lineAround(Cell cell) const {
  const GridGeometry& at = window_.geometry;
  const SurfacePoint& middle = surface_[window_.indexOf(cell)];
  const Eigen::Vector2d middle_m(static_cast<double>(middle.x_m), static_cast<double>(middle.y_m));
  const int reach = static_cast<int>(std::ceil(line_radius_m_ / at.resolution_m));
  double total = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  int count = 0;
  for (int row = std::max(0, cell.row - reach); row <= std::min(at.rows - 1, cell.row + reach); ++row)
    for (int col = std::max(0, cell.col - reach); col <= std::min(at.cols - 1, cell.col + reach); ++col) {
      const SurfacePoint& point = surface_[window_.indexOf({col, row})];
      if (point.weight <= 0) continue;
      const Eigen::Vector2d off_m =
          Eigen::Vector2d(static_cast<double>(point.x_m), static_cast<double>(point.y_m)) - middle_m;
      if (off_m.norm() > line_radius_m_) continue;
      const double weight = static_cast<double>(point.weight);
      total += weight;
      sum += weight * off_m;
      squares += weight * off_m * off_m.transpose();
      ++count;
    }
  constexpr int kMinPoints = 4;
  constexpr double kMaxThickness =
      0.15;  // variance across over variance along: corners and clutter have no normal
  if (count < kMinPoints) return std::nullopt;
  const Eigen::Vector2d mean = sum / total;
  const Eigen::Matrix2d covariance = squares / total - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(covariance);
  if (solver.eigenvalues()(0) > kMaxThickness * solver.eigenvalues()(1)) return std::nullopt;
  return SurfaceLine{middle_m + mean, solver.eigenvectors().col(0)};
}

}  // namespace cornerstone
