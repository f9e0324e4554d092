// A snapshot of an occupancy grid as a plain value: what landmarks, registration, files and messages work on.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/grid_geometry.h"

namespace cornerstone {

// Probability of cells that were never seen.
constexpr float kUnseen = 0.5f;

// Where within (or beside) its cell a surface lies: the weighted mean of the looks it caused. This is what
// lets scans and maps be fitted to millimetres on a grid of 5 cm.
struct SurfacePoint {
  float x_m = 0;  // in the map frame
  float y_m = 0;
  float weight = 0;  // 1 / variance in 1/m^2; 0: none
  Eigen::Vector2d position_m() const { return Eigen::Vector2f(x_m, y_m).cast<double>(); }
};

struct GridMap {
  GridGeometry geometry;
  cv::Mat1f
      occupied;  // probability in [0, 1], rows x cols, row 0 at the smallest y; kUnseen exactly: never seen
  // Of its occupied cells, in no order that counts. Empty: not known, as in a map read from a file.
  std::vector<SurfacePoint> surface = {};
};

// Mean position of the cells that were seen, in the map's frame; its origin when there are none.
Eigen::Vector2d knownCentre(const GridMap& map);

}  // namespace cornerstone
