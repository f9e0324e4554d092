// Distance to the nearest edge over a map (paper, section 3.3), computed once, read at any point by bilinear
// interpolation with its gradient. Everything in cells (col, row) of the map, whole numbers at cell centres.
// Farther than kReachCells from every edge the field stays at kReachCells + 1: the fit starts well inside
// that. Beyond the map the field goes on with its border values, and its gradient there is zero across the
// border.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/grid_geometry.h"
#include "cornerstone/landmarks/edges.h"

namespace cornerstone {

constexpr int kReachCells = 6;

class DistanceField {
 public:
  DistanceField(const std::vector<EdgePoint>& edges, const GridGeometry& geometry);

  double at(const Eigen::Vector2d& point_cells) const;
  double at(const Eigen::Vector2d& point_cells, Eigen::Vector2d& gradient) const;
  const cv::Mat1f& cells() const { return distances_; }  // at the cell centres

 private:
  cv::Mat1f distances_;
};

}  // namespace cornerstone
