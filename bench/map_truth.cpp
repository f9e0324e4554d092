#include "map_truth.h"

#include <algorithm>
#include <cmath>

#include "bench.h"

namespace cornerstone::bench {
namespace {

constexpr double kNear_m = 0.10, kWay_m = 3;
constexpr float kOccupied = 0.65F, kUntold = 0.01F;  // either side of 1/2

std::vector<Solid> solidsInBand(const World& world) {
  const HeightBand band;
  std::vector<Solid> solids;
  for (const Solid& solid : solidsOf(world))
    if (solid.z_max_m > band.z_min_m && solid.z_min_m < band.z_max_m) solids.push_back(solid);
  return solids;
}

double share(std::size_t part, std::size_t all) {
  return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

MapTruth::MapTruth(const World& world, const std::vector<Pose2>& world_from_bases)
    : solids_(solidsInBand(world)), surfaces_(solidsOf(world)) {
  std::vector<bool> seen(surfaces_.points().size(), false);
  for (const Pose2& pose : world_from_bases) {
    if (!way_m_.empty() && (way_m_.back() - pose.translation()).norm() < 0.1) continue;
    way_m_.push_back(pose.translation());
  }
  for (std::size_t i = 0; i < world_from_bases.size(); i += 2)
    for (const std::size_t point : surfaces_.visibleFrom(world_from_bases[i], Sight{})) seen[point] = true;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i]) seen_m_.push_back(surfaces_.points()[i]);
}

bool MapTruth::inside(const Eigen::Vector2d& point_m) const {
  return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& solid) {
    const auto& corners = solid.polygon_m;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d along = corners[(i + 1) % corners.size()] - corners[i], to = point_m - corners[i];
      if (along.x() * to.y() - along.y() * to.x() < 0) return false;
    }
    return true;
  });
}

bool MapTruth::nearWay(const Eigen::Vector2d& point_m) const {
  return std::any_of(way_m_.begin(), way_m_.end(),
                     [&](const Eigen::Vector2d& at_m) { return (at_m - point_m).norm() <= kWay_m; });
}

MapWorth MapTruth::worthOf(const GridMap& map, const Pose2& world_from_map) const {
  std::vector<Eigen::Vector2d> occupied_m;
  std::vector<double> distances_m;
  std::size_t right = 0, free = 0, phantoms = 0;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      const float value = map.occupied(row, col);
      if (std::abs(value - kUnseen) < kUntold) continue;
      const Eigen::Vector2d at_m = world_from_map * map.geometry.centreOf({col, row});
      const bool occupied = value > kOccupied;
      const double away_m = surfaces_.distanceTo(at_m);
      const bool truly_free = away_m > kNear_m && !inside(at_m);
      free += truly_free;
      phantoms += truly_free && occupied;
      if (!occupied) continue;
      occupied_m.push_back(at_m);
      right += away_m <= kNear_m;
      if (nearWay(at_m)) distances_m.push_back(away_m);
    }
  std::size_t mapped = 0;
  for (const Eigen::Vector2d& point_m : seen_m_)
    mapped += std::any_of(occupied_m.begin(), occupied_m.end(), [&](const Eigen::Vector2d& cell_m) {
      return (cell_m - point_m).norm() <= kNear_m;
    });
  return {share(right, occupied_m.size()), share(mapped, seen_m_.size()), share(phantoms, free),
          median(distances_m)};
}

}  // namespace cornerstone::bench
