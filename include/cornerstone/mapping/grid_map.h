// A snapshot of an occupancy grid as a plain value: what landmarks, registration, files and messages work on.
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/base/grid_geometry.h"

namespace cornerstone {

// Probability of cells that were never seen.
constexpr float kUnseen = 0.5f;

struct GridMap {
  GridGeometry geometry;
  cv::Mat1f
      occupied;  // probability in [0, 1], rows x cols, row 0 at the smallest y; kUnseen exactly: never seen
};

// Mean position of the cells that were seen, in the map's frame; its origin when there are none.
Eigen::Vector2d knownCentre(const GridMap& map);

}  // namespace cornerstone
