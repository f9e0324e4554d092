// Finds the edges near a point: square buckets over the bounding box of the edges. Metres of the map's frame.
#pragma once

#include <algorithm>
#include <vector>

#include "cornerstone/landmarks/edges.h"

namespace cornerstone {

class EdgeIndex {
 public:
  // bucket_m is the largest search radius.
  EdgeIndex(const std::vector<EdgePoint>& edges, double bucket_m);

  // Calls visit(edge) for every edge in the buckets around a point: all within bucket_m, and some beyond.
  template <typename Visit>
  void forEachNear(const Eigen::Vector2d& point_m, Visit visit) const {
    if (edges_.empty()) return;
    const int col = bucket(point_m.x() - origin_m_.x()), row = bucket(point_m.y() - origin_m_.y());
    if (col < -1 || row < -1 || col > cols_ || row > rows_) return;
    const int first = std::max(col - 1, 0), last = std::min(col + 1, cols_ - 1);
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
      const EdgePoint* const end = edges_.data() + starts_[static_cast<std::size_t>(r * cols_ + last + 1)];
      for (const EdgePoint* edge = edges_.data() + starts_[static_cast<std::size_t>(r * cols_ + first)];
           edge != end; ++edge)
        visit(*edge);
    }
  }

  // The nearest edge whose normal is within 45 degrees of the given one; null: none within the radius (<=
  // bucket_m).
  const EdgePoint* nearest(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal,
                           double radius_m) const;

  const std::vector<EdgePoint>& edges() const { return edges_; }  // bucket by bucket

 private:
  int bucket(double offset_m) const;

  double bucket_m_;
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();
  int cols_ = 0;
  int rows_ = 0;
  std::vector<int> starts_;  // per bucket, the first of its edges
  std::vector<EdgePoint> edges_;
};

}  // namespace cornerstone
