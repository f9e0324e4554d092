// Parts of a map that share its cells: work is bounded by what is known, not by the grid that holds it.
#pragma once

#include <algorithm>
#include <iterator>
#include <opencv2/core.hpp>

#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

inline GridGeometry croppedGeometry(const GridGeometry& geometry, const cv::Rect& cells) {
  GridGeometry crop = geometry;
  crop.origin_x_m += cells.x * geometry.resolution_m;
  crop.origin_y_m += cells.y * geometry.resolution_m;
  crop.cols = cells.width;
  crop.rows = cells.height;
  return crop;
}

inline GridMap cropped(const GridMap& map, const cv::Rect& cells) {
  GridMap crop{croppedGeometry(map.geometry, cells), map.occupied(cells)};
  std::copy_if(map.surface.begin(), map.surface.end(), std::back_inserter(crop.surface),
               [&](const SurfacePoint& point) {
                 return crop.geometry.contains(crop.geometry.cellAt(point.position_m()));
               });
  return crop;
}

// Its lower corner moved down to a multiple of `step` cells: squares of cells stay those of the whole map.
inline cv::Rect aligned(const cv::Rect& cells, int step) {
  return cv::Rect(cv::Point(cells.x / step * step, cells.y / step * step), cells.br());
}

}  // namespace cornerstone
