#include "cornerstone/registration/merge_maps.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

// The reference grid, grown by whole cells on each side to hold the others.
GridGeometry unionGeometry(const GridGeometry& reference, const std::vector<PlacedMap>& others) {
  int left = 0, bottom = 0, right = reference.cols - 1, top = reference.rows - 1;
  for (const PlacedMap& other : others) {
    const GridGeometry& grid = other.map.geometry;
    if (other.map.occupied.empty()) continue;
    for (const Cell corner :
         {Cell{0, 0}, Cell{grid.cols - 1, 0}, Cell{0, grid.rows - 1}, Cell{grid.cols - 1, grid.rows - 1}}) {
      const Cell cell = reference.cellAt(other.reference_from_map * grid.centreOf(corner));
      left = std::min(left, cell.col);
      right = std::max(right, cell.col);
      bottom = std::min(bottom, cell.row);
      top = std::max(top, cell.row);
    }
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

void add(const PlacedMap& other, GridMap& merged) {
  const Pose2 map_from_reference = other.reference_from_map.inverse();
  for (int row = 0; row < merged.geometry.rows; ++row)
    for (int col = 0; col < merged.geometry.cols; ++col) {
      float& value = merged.occupied(row, col);
      value = combine(value, valueAt(other.map, map_from_reference * merged.geometry.centreOf({col, row})));
    }
}

}  // namespace

GridMap mergeMaps(const GridMap& reference, const std::vector<PlacedMap>& others) {
  GridMap merged;
  merged.geometry = unionGeometry(reference.geometry, others);
  merged.occupied = cv::Mat1f(merged.geometry.rows, merged.geometry.cols, kUnseen);
  const Cell first = merged.geometry.cellAt(reference.geometry.centreOf({0, 0}));
  reference.occupied.copyTo(
      merged.occupied({first.col, first.row, reference.geometry.cols, reference.geometry.rows}));
  for (const PlacedMap& other : others)
    if (!other.map.occupied.empty()) add(other, merged);
  return merged;
}

}  // namespace cornerstone
