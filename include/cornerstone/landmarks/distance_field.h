// Distance to the nearest edge over a map (paper, section 3.3), computed once, read at any point by bilinear
// interpolation with its gradient. Everything in cells (col, row) of the map, whole numbers at cell centres;
// distances are right to 1/32 cell. Farther than kReachCells from every edge the field stays at kReachCells +
// 1: the fit starts well inside that. Beyond the map the field goes on with its border values, and its
// gradient there is zero across the border.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/grid_geometry.h"
#include "cornerstone/landmarks/edges.h"

namespace cornerstone {

constexpr int kReachCells = 6;
constexpr int kDistanceUnits = 32;  // of a stored distance, to the cell

class DistanceField {
 public:
  DistanceField(const std::vector<EdgePoint>& edges, const GridGeometry& geometry);

  double at(const Eigen::Vector2d& point_cells) const;
  double at(const Eigen::Vector2d& point_cells, Eigen::Vector2d& gradient) const {
    const double x = point_cells.x(), y = point_cells.y();
    if (!(x >= 0 && y >= 0 && x < distances_.cols - 1 && y < distances_.rows - 1))
      return atBorder(point_cells, gradient);
    const int col = static_cast<int>(x), row = static_cast<int>(y);
    const unsigned char* below = distances_[row] + col;
    const unsigned char* above = distances_[row + 1] + col;
    return interpolate({below[0], below[1], above[0], above[1]}, {x - col, y - row}, gradient);
  }
  const cv::Mat1b& cells() const { return distances_; }  // at the cell centres, in kDistanceUnits to the cell

 private:
  bool isEdge(int col, int row) const;

  struct Square {
    int a, b, c, d;  // a and b below, c and d above, from the left
  };
  // Between four cells' centres, at a share of the way from the lower left one.
  static double interpolate(const Square& square, const Eigen::Vector2d& share, Eigen::Vector2d& gradient) {
    constexpr double kCells = 1.0 / kDistanceUnits;
    const double u = share.x(), v = share.y();
    const double below = square.b - square.a, above = square.d - square.c;
    const double low = square.a + u * below, high = square.c + u * above;
    gradient = {kCells * (below + v * (above - below)), kCells * (high - low)};
    return kCells * (low + v * (high - low));
  }
  double atBorder(const Eigen::Vector2d& point_cells, Eigen::Vector2d& gradient) const;

  cv::Mat1b distances_;
};

}  // namespace cornerstone
