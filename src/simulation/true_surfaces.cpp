#include "cornerstone/simulation/true_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace cornerstone {
namespace {

constexpr double kPointDistance_m = 0.02;  // finer than any map's cells
constexpr double kRayStep_rad = 0.2 * M_PI / 180;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

TrueSurfaces::TrueSurfaces(const std::vector<Solid>& solids, const HeightBand& band) {
  for (const Solid& solid : solids) {
    if (solid.z_max_m <= band.z_min_m || solid.z_min_m >= band.z_max_m) continue;
    for (std::size_t i = 0; i < solid.polygon_m.size(); ++i) {
      Edge edge;
      edge.from_m = solid.polygon_m[i];
      edge.to_m = solid.polygon_m[(i + 1) % solid.polygon_m.size()];
      edge.length_m = (edge.to_m - edge.from_m).norm();
      if (edge.length_m <= 0) continue;
      edge.first_point = points_m_.size();
      edge.point_count = std::size_t(std::ceil(edge.length_m / kPointDistance_m)) + 1;
      for (std::size_t k = 0; k < edge.point_count; ++k) {
        const double share = double(k) / double(edge.point_count - 1);
        points_m_.push_back(edge.from_m + (edge.to_m - edge.from_m) * share);
      }
      edges_.push_back(edge);
    }
  }
}

bool TrueSurfaces::cast(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, Hit& hit) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Eigen::Vector2d along = edges_[i].to_m - edges_[i].from_m;
    const double determinant = cross(direction, along);
    // Outlines run counter-clockwise: only a side that faces the eye can be seen.
    if (determinant >= -1e-12) continue;
    const Eigen::Vector2d offset_m = edges_[i].from_m - from_m;
    const double range_m = cross(offset_m, along) / determinant;
    const double share = cross(offset_m, direction) / determinant;
    if (range_m <= 0 || range_m >= nearest_m || share < 0 || share > 1) continue;
    nearest_m = range_m;
    hit = {i, share * edges_[i].length_m, range_m};
  }
  return std::isfinite(nearest_m);
}

std::vector<std::size_t> TrueSurfaces::visibleFrom(const Pose2& world_from_camera, const Sight& sight) const {
  std::set<std::size_t> seen;
  const Eigen::Vector2d eye_m = world_from_camera.translation();
  Hit previous;
  bool had_previous = false;
  const int rays = int(std::ceil(sight.field_of_view_rad / kRayStep_rad));
  for (int k = 0; k <= rays; ++k) {
    const double bearing = world_from_camera.yaw_rad + sight.field_of_view_rad * (double(k) / rays - 0.5);
    Hit hit;
    const bool has_hit =
        cast(eye_m, {std::cos(bearing), std::sin(bearing)}, hit) && hit.range_m <= sight.range_m;
    if (has_hit) {
      // Neighbouring rays on one side see all of it that lies between them.
      const bool same_side = had_previous && previous.edge == hit.edge;
      const double from_m = same_side ? std::min(previous.along_m, hit.along_m) : hit.along_m;
      const double to_m = same_side ? std::max(previous.along_m, hit.along_m) : hit.along_m;
      const Edge& edge = edges_[hit.edge];
      const double points_per_m = double(edge.point_count - 1) / edge.length_m;
      const auto last = std::size_t(std::floor(to_m * points_per_m));
      for (auto i = std::size_t(std::ceil(from_m * points_per_m)); i <= last && i < edge.point_count; ++i)
        seen.insert(edge.first_point + i);
    }
    previous = hit;
    had_previous = has_hit;
  }
  return {seen.begin(), seen.end()};
}

double TrueSurfaces::distanceTo(const Eigen::Vector2d& point_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges_) {
    const Eigen::Vector2d along = edge.to_m - edge.from_m;
    const double share = std::clamp((point_m - edge.from_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest_m = std::min(nearest_m, (point_m - edge.from_m - along * share).norm());
  }
  return nearest_m;
}

}  // namespace cornerstone
