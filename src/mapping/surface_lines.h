// The surfaces of a piece of the map as points with normals, found by place.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/mapping/occupancy_grid.h"

namespace cornerstone {

struct SurfaceLine {
  Eigen::Vector2d point_m;
  Eigen::Vector2d normal;
};

class SurfaceLines {
 public:
  SurfaceLines(const OccupancyGrid& grid, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m,
               double line_radius_m);
  // Nearest surface point within gate_m, if its neighbours form a line.
  std::optional<SurfaceLine> nearest(const Eigen::Vector2d& point_m, double gate_m) const;
  // Whether the map knows the point to be free and no surface point lies within gate_m.
  bool isFree(const Eigen::Vector2d& point_m, double gate_m) const;

 private:
  std::optional<Cell> nearestCell(const Eigen::Vector2d& point_m, double gate_m) const;
  std::optional<SurfaceLine> lineAround(Cell cell) const;
  CellWindow window_;
  std::vector<SurfacePoint> surface_;
  double line_radius_m_;
  // Around each cell asked for: neighbouring ends ask for the same.
  mutable std::vector<std::optional<SurfaceLine>> lines_;
  mutable std::vector<int> line_of_cell_;  // one of lines_; -1: nobody has asked
};

}  // namespace cornerstone
