#include "cornerstone/landmarks/surface_edges.h"

#include <cmath>

namespace cornerstone {
namespace {

// Along the wall: some cells' points make a steady mean, and a wall's end is not the next wall.
constexpr double kAlong_m = 0.15;
// Across it: an edge's distance from its surface and half a cell, less than a thin wall's other face is away.
constexpr double kAcross_m = 0.08;

struct WeightedOffset {
  double weight = 0, sum = 0;
};

}  // namespace

std::vector<EdgePoint> edgesOnSurface(const EdgeIndex& edges, const std::vector<SurfacePoint>& surface) {
  std::vector<EdgePoint> moved = edges.edges();
  std::vector<WeightedOffset> offsets(moved.size());
  for (const SurfacePoint& point : surface) {
    const Eigen::Vector2d at_m = point.position_m();
    const auto weight = static_cast<double>(point.weight);
    edges.forEachNear(at_m, std::hypot(kAlong_m, kAcross_m), [&](const EdgePoint& edge) {
      const Eigen::Vector2d from_edge_m = at_m - edge.position_m;
      const double across_m = edge.normal.dot(from_edge_m);
      const double along_m = edge.normal.x() * from_edge_m.y() - edge.normal.y() * from_edge_m.x();
      if (std::abs(across_m) > kAcross_m || std::abs(along_m) > kAlong_m) return;
      WeightedOffset& offset = offsets[static_cast<std::size_t>(&edge - edges.edges().data())];
      offset.weight += weight;
      offset.sum += weight * across_m;
    });
  }
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (offsets[i].weight > 0) moved[i].position_m += offsets[i].sum / offsets[i].weight * moved[i].normal;
  return moved;
}

}  // namespace cornerstone
