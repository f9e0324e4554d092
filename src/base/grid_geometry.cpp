#include "cornerstone/base/grid_geometry.h"

#include <cmath>

namespace cornerstone {

Cell GridGeometry::cellAt(const Eigen::Vector2d& point_m) const {
  return {static_cast<int>(std::floor((point_m.x() - origin_x_m) / resolution_m)),
          static_cast<int>(std::floor((point_m.y() - origin_y_m) / resolution_m))};
}

Eigen::Vector2d GridGeometry::centreOf(Cell cell) const { return toMetres({cell.col, cell.row}); }

Eigen::Vector2d GridGeometry::toCells(const Eigen::Vector2d& point_m) const {
  return {(point_m.x() - origin_x_m) / resolution_m - 0.5, (point_m.y() - origin_y_m) / resolution_m - 0.5};
}

Eigen::Vector2d GridGeometry::toMetres(const Eigen::Vector2d& point_cells) const {
  return {origin_x_m + (point_cells.x() + 0.5) * resolution_m,
          origin_y_m + (point_cells.y() + 0.5) * resolution_m};
}

}  // namespace cornerstone
