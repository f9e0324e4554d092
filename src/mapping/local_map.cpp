#include "cornerstone/mapping/local_map.h"

#include <cmath>
#include <utility>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// The box of a local map's corners in the map frame.
void extend(const LocalMap& local, std::size_t level, Eigen::Vector2d& low_m, Eigen::Vector2d& high_m) {
  const GridGeometry from = local.grid(level).geometry();
  const Eigen::Vector2d origin_m(from.origin_x_m, from.origin_y_m);
  for (const int col : {0, from.cols})
    for (const int row : {0, from.rows}) {
      const Eigen::Vector2d corner_m =
          local.mapFromLocal() * Eigen::Vector2d(origin_m + from.resolution_m * Eigen::Vector2d(col, row));
      low_m = low_m.cwiseMin(corner_m);
      high_m = high_m.cwiseMax(corner_m);
    }
}

void draw(const LocalMap& local, std::size_t level, GridMap& map) {
  const GridMap part = local.grid(level).snapshot();
  const Pose2 local_from_map = local.mapFromLocal().inverse();
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      const Cell cell = part.geometry.cellAt(local_from_map * map.geometry.centreOf({col, row}));
      if (!part.geometry.contains(cell)) continue;
      const float here = part.occupied(cell.row, cell.col);
      float& known = map.occupied(row, col);
      if (std::abs(here - kUnseen) > std::abs(known - kUnseen)) known = here;
    }
  for (const SurfacePoint& point : part.surface) {
    const Eigen::Vector2f at_m = (local.mapFromLocal() * point.position_m()).cast<float>();
    map.surface.push_back({at_m.x(), at_m.y(), point.weight});
  }
}

}  // namespace

LocalMap::LocalMap(const GridParams& params, std::size_t levels) {
  if (levels == 0) throw std::logic_error("LocalMap: no level");
  grids_.assign(levels, OccupancyGrid(params));
}

void LocalMap::insert(const RangeScan& scan, const Pose2& local_from_base, const LookMotion& motion) {
  if (scan.further_levels.size() >= grids_.size())
    throw InputError("range scan: it has more levels than the map");
  grids_.front().insert(scan, local_from_base, motion);
  for (std::size_t level = 1; level <= scan.further_levels.size(); ++level)
    grids_[level].insert(levelOf(scan, level), local_from_base, motion);
}

void LocalMap::clear() {
  for (OccupancyGrid& grid : grids_) grid.clear();
}

void LocalMap::becomeRedrawn(LocalMap&& redrawn) {
  for (std::size_t level = 0; level < grids_.size(); ++level)
    grids_[level].becomeRedrawn(std::move(redrawn.grids_.at(level)));
}

GridMap composed(const std::vector<LocalMap>& maps, std::size_t level) {
  const Pose2 first = maps.front().mapFromLocal();
  if (maps.size() == 1 && first.translation().isZero() && first.yaw_rad == 0)
    return maps.front().grid(level).snapshot();
  GridMap map;
  map.geometry = maps.front().grid(level).geometry();
  const double resolution_m = map.geometry.resolution_m;
  constexpr double kFar_m = 1e9;
  Eigen::Vector2d low_m(kFar_m, kFar_m), high_m(-kFar_m, -kFar_m);
  for (const LocalMap& local : maps)
    if (!local.grid(level).empty()) extend(local, level, low_m, high_m);
  if (low_m.x() > high_m.x()) return map;
  const GridGeometry whole{resolution_m, 0, 0, 0, 0};
  const Eigen::Vector2d half_cell = Eigen::Vector2d::Constant(resolution_m / 2);
  const Cell first_cell = whole.cellAt(low_m + half_cell), last_cell = whole.cellAt(high_m - half_cell);
  map.geometry = {resolution_m, first_cell.col * resolution_m, first_cell.row * resolution_m,
                  last_cell.col - first_cell.col + 1, last_cell.row - first_cell.row + 1};
  map.occupied = cv::Mat1f(map.geometry.rows, map.geometry.cols, kUnseen);
  for (const LocalMap& local : maps)
    if (!local.grid(level).empty()) draw(local, level, map);
  return map;
}

}  // namespace cornerstone
