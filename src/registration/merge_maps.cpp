#include "cornerstone/registration/merge_maps.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

// Whole cells by which the reference grid must grow on each side to hold the current one.
GridGeometry unionGeometry(const GridGeometry& reference, const GridGeometry& current,
                           const Pose2& reference_from_current) {
  int left = 0, bottom = 0, right = reference.cols - 1, top = reference.rows - 1;
  for (const Cell corner : {Cell{0, 0}, Cell{current.cols - 1, 0}, Cell{0, current.rows - 1},
                            Cell{current.cols - 1, current.rows - 1}}) {
    const Cell cell = reference.cellAt(reference_from_current * current.centreOf(corner));
    left = std::min(left, cell.col);
    right = std::max(right, cell.col);
    bottom = std::min(bottom, cell.row);
    top = std::max(top, cell.row);
  }
  GridGeometry merged = reference;
  merged.cols = right - left + 1;
  merged.rows = top - bottom + 1;
  merged.origin_x_m += left * reference.resolution_m;
  merged.origin_y_m += bottom * reference.resolution_m;
  return merged;
}

float valueAt(const GridMap& map, const Eigen::Vector2d& point_m) {
  const Cell cell = map.geometry.cellAt(point_m);
  return map.geometry.contains(cell) ? map.occupied(cell.row, cell.col) : kUnseen;
}

// Adds the log-odds of two probabilities; 0 and 1 are held just inside, so that certainty can still be
// outvoted.
float combine(float a, float b) {
  if (a == kUnseen) return b;
  if (b == kUnseen) return a;
  const float pa = std::clamp(a, 0.001f, 0.999f), pb = std::clamp(b, 0.001f, 0.999f);
  return pa * pb / (pa * pb + (1 - pa) * (1 - pb));
}

}  // namespace

GridMap mergeMaps(const GridMap& reference, const GridMap& current, const Pose2& reference_from_current) {
  if (current.occupied.empty()) return {reference.geometry, reference.occupied.clone()};
  GridMap merged;
  merged.geometry = unionGeometry(reference.geometry, current.geometry, reference_from_current);
  merged.occupied.create(merged.geometry.rows, merged.geometry.cols);
  const Pose2 current_from_reference = reference_from_current.inverse();
  for (int row = 0; row < merged.geometry.rows; ++row)
    for (int col = 0; col < merged.geometry.cols; ++col) {
      const Eigen::Vector2d point_m = merged.geometry.centreOf({col, row});
      merged.occupied(row, col) =
          combine(valueAt(reference, point_m), valueAt(current, current_from_reference * point_m));
    }
  return merged;
}

}  // namespace cornerstone
