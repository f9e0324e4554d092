#include "cornerstone/landmarks/distance_field.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cornerstone {

DistanceField::DistanceField(const std::vector<EdgePoint>& edges, const GridGeometry& geometry) {
  cv::Mat1b away(geometry.rows, geometry.cols, static_cast<unsigned char>(1));
  for (const EdgePoint& edge : edges) {
    const Cell cell = geometry.cellAt(edge.position_m);
    if (geometry.contains(cell)) away(cell.row, cell.col) = 0;
  }
  cv::distanceTransform(away, distances_, cv::DIST_L2, cv::DIST_MASK_5);
}

double DistanceField::at(const Eigen::Vector2d& point_cells) const {
  Eigen::Vector2d gradient;
  return at(point_cells, gradient);
}

double DistanceField::at(const Eigen::Vector2d& point_cells, Eigen::Vector2d& gradient) const {
  const double x = std::clamp(point_cells.x(), 0.0, static_cast<double>(distances_.cols - 1));
  const double y = std::clamp(point_cells.y(), 0.0, static_cast<double>(distances_.rows - 1));
  const int col = std::min(static_cast<int>(x), std::max(distances_.cols - 2, 0));
  const int row = std::min(static_cast<int>(y), std::max(distances_.rows - 2, 0));
  const int right = std::min(col + 1, distances_.cols - 1), up = std::min(row + 1, distances_.rows - 1);
  const double u = x - col, v = y - row;
  const double a = distances_(row, col), b = distances_(row, right);
  const double c = distances_(up, col), d = distances_(up, right);
  gradient.x() = x == point_cells.x() ? (1 - v) * (b - a) + v * (d - c) : 0;
  gradient.y() = y == point_cells.y() ? (1 - u) * (c - a) + u * (d - b) : 0;
  return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
}

}  // namespace cornerstone
