#include "cornerstone/landmarks/edge_index.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cornerstone {
namespace {

constexpr double kSameSideCosine =
    0.7071;  // 45 degrees: the two faces of a wall and the arms of a corner stay apart
constexpr double kCloseShare = 0.25;  // of a search radius
constexpr double kMaxBuckets = 5e7;

}  // namespace

EdgeIndex::EdgeIndex(const std::vector<EdgePoint>& edges, double bucket_m) : per_bucket_(1 / bucket_m) {
  if (edges.empty()) return;
  if (!(bucket_m > 0)) throw std::invalid_argument("EdgeIndex: bucket_m must be positive");
  Eigen::Vector2d low = edges.front().position_m, high = low;
  for (const EdgePoint& edge : edges) {
    low = low.cwiseMin(edge.position_m);
    high = high.cwiseMax(edge.position_m);
  }
  origin_m_ = low;
  const Eigen::Vector2d size = (high - low) / bucket_m;
  if ((size.x() + 1) * (size.y() + 1) > kMaxBuckets)
    throw std::invalid_argument("EdgeIndex: buckets too small");
  cols_ = bucket(high.x() - low.x()) + 1;
  rows_ = bucket(high.y() - low.y()) + 1;
  starts_.assign(static_cast<std::size_t>(cols_ * rows_ + 1), 0);
  std::vector<int> bucket_of(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector2d offset = edges[i].position_m - low;
    bucket_of[i] = bucket(offset.y()) * cols_ + bucket(offset.x());
    ++starts_[static_cast<std::size_t>(bucket_of[i] + 1)];
  }
  for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  edges_.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
    edges_[static_cast<std::size_t>(next[static_cast<std::size_t>(bucket_of[i])]++)] = edges[i];
}

// What is found close by is the nearest one: most have theirs there, and fewer buckets are looked through.
const EdgePoint* EdgeIndex::nearest(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal,
                                    double radius_m) const {
  const EdgePoint* const close = nearestWithin(point_m, normal, kCloseShare * radius_m);
  return close != nullptr ? close : nearestWithin(point_m, normal, radius_m);
}

const EdgePoint* EdgeIndex::nearestWithin(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal,
                                          double radius_m) const {
  const EdgePoint* best = nullptr;
  double best_squared = radius_m * radius_m;
  forEachNear(point_m, radius_m, [&](const EdgePoint& edge) {
    const double squared = (edge.position_m - point_m).squaredNorm();
    if (squared <= best_squared && edge.normal.dot(normal) > kSameSideCosine) {
      best_squared = squared;
      best = &edge;
    }
  });
  return best;
}

}  // namespace cornerstone
