// Finds the edges near a point: square buckets over the bounding box of the edges. Metres of the map's frame.
#pragma once

#include <algorithm>
#include <vector>

#include "cornerstone/landmarks/edges.h"

namespace cornerstone {

class EdgeIndex {
 public:
  // bucket_m: a third to the whole of the usual search radius.
  EdgeIndex(const std::vector<EdgePoint>& edges, double bucket_m);

  // Calls visit(edge) for every edge in the buckets that a square around a point touches: all within radius_m
  // of it, and some beyond.
  template <typename Visit>
  void forEachNear(const Eigen::Vector2d& point_m, double radius_m, Visit visit) const {
    const Eigen::Vector2d low = point_m - origin_m_ - Eigen::Vector2d::Constant(radius_m);
    const int first = std::max(bucket(low.x()), 0),
              last = std::min(bucket(low.x() + 2 * radius_m), cols_ - 1);
    if (first > last) return;
    const int top = std::min(bucket(low.y() + 2 * radius_m), rows_ - 1);
    for (int r = std::max(bucket(low.y()), 0); r <= top; ++r) {
      const EdgePoint* const end = edges_.data() + starts_[static_cast<std::size_t>(r * cols_ + last + 1)];
      for (const EdgePoint* edge = edges_.data() + starts_[static_cast<std::size_t>(r * cols_ + first)];
           edge != end; ++edge)
        visit(*edge);
    }
  }

  // The nearest edge whose normal is within 45 degrees of the given one; null: none within the radius.
  const EdgePoint* nearest(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal,
                           double radius_m) const;

  const std::vector<EdgePoint>& edges() const { return edges_; }  // bucket by bucket

 private:
  const EdgePoint* nearestWithin(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal,
                                 double radius_m) const;
  // Of an offset from the origin; far ones are somewhere beyond either end.
  int bucket(double offset_m) const {
    return static_cast<int>(std::clamp(offset_m * per_bucket_, -2.0, 1e9) + 2) - 2;  // rounds down
  }

  double per_bucket_;
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();
  int cols_ = 0;
  int rows_ = 0;
  std::vector<int> starts_;  // per bucket, the first of its edges
  std::vector<EdgePoint> edges_;
};

}  // namespace cornerstone
