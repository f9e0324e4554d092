#include "cornerstone/mapping/occupancy_grid.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"
#include "scan_wedge.h"

namespace cornerstone {
namespace {

constexpr float kMaxSurfaceWeight = 1e5F;  // 1/m^2, 3 mm: older looks fade, so that surfaces can move
constexpr double kSurfaceOccupied = 0.3;   // P from which a cell's surface point counts

bool finite(const RangeScan& scan) {
  return std::all_of(scan.beams.begin(), scan.beams.end(), [](const Beam& beam) {
    return std::isfinite(beam.bearing_rad) && beam.width_rad > 0 &&
           (!beam.hit || (beam.range_m > 0 && beam.near_m <= beam.range_m && beam.far_m >= beam.range_m &&
                          std::isfinite(beam.far_m) && beam.sigma_m > 0 && beam.clear_m >= 0));
  });
}

// Calls part(tile index, first cell within the tile, first cell within the window, count of columns) row by
// row.
template <typename Part>
void forEachRowPart(const CellWindow& window, const Part& part) {
  for (int row = 0; row < window.geometry.rows; ++row) {
    int col = 0;
    while (col < window.geometry.cols) {
      const Cell cell{window.first.col + col, window.first.row + row};
      const TileIndex tile = tileOf(cell);
      const Cell first = firstCellOf(tile);
      const Cell inside{cell.col - first.col, cell.row - first.row};
      const int count = std::min(kTileCells - inside.col, window.geometry.cols - col);
      part(tile, inside, Cell{col, row}, count);
      col += count;
    }
  }
}

}  // namespace

void describe(ParamVisitor& visitor, GridParams& params) {
  visitor.field("resolution_m", params.resolution_m);
  visitor.field("max_range_m", params.max_range_m);
  visitor.field("max_sigma_m", params.max_sigma_m);
  visitor.field("prior_occupied", params.prior_occupied);
  visitor.field("outlier_ratio", params.outlier_ratio);
  visitor.field("free_step", params.free_step);
  visitor.field("occupied_step", params.occupied_step);
  visitor.field("min_log_odds", params.min_log_odds);
  visitor.field("max_log_odds", params.max_log_odds);
  visitor.field("new_look_ratio", params.new_look_ratio);
  visitor.degrees("new_look_deg", params.new_look_rad);
  visitor.field("min_new_share", params.min_new_share);
}

OccupancyGrid::OccupancyGrid(const GridParams& params) : params_(params), scale_(0.03) {
  requireWithin(params.resolution_m, 0.02, 0.20, "resolution_m");
  requireWithin(params.max_range_m, 0.5, 100, "max_range_m");
  requireWithin(params.max_sigma_m, 0.001, 100, "max_sigma_m");
  requireWithin(params.prior_occupied, 0.001, 0.4, "prior_occupied");
  requireWithin(params.outlier_ratio, 0.001, 0.5, "outlier_ratio");
  requireWithin(params.free_step, 0.1, 5, "free_step");
  requireWithin(params.occupied_step, 0.1, 7, "occupied_step");
  requireWithin(params.min_log_odds, -7.5, -1, "min_log_odds");
  requireWithin(params.max_log_odds, 1, 7.5, "max_log_odds");
  requireWithin(params.new_look_ratio, 1e-4, 10, "new_look_ratio");
  requireWithin(params.new_look_rad, 1e-4, 10, "new_look_deg");
  requireWithin(params.min_new_share, 0.001, 1, "min_new_share");
  scale_ = EvidenceScale(params.prior_occupied);
}

namespace {

// Poses beyond these are faults of odometry: a map of more cells fits neither memory nor a message.
constexpr double kFarthest_cells = 1e5;  // from the map frame's origin: 5 km at 0.05 m
constexpr double kMostCells = 1e8;       // 500 m x 500 m at 0.05 m

void requireRoomFor(const Eigen::Vector2d& at_m, const GridGeometry& known) {
  const Eigen::Vector2d low(known.origin_x_m, known.origin_y_m);
  const Eigen::Vector2d high = low + known.resolution_m * Eigen::Vector2d(known.cols, known.rows);
  const Eigen::Vector2d span_cells = (high.cwiseMax(at_m) - low.cwiseMin(at_m)) / known.resolution_m;
  if (at_m.norm() > kFarthest_cells * known.resolution_m || span_cells.prod() > kMostCells)
    throw InputError("pose of the range scan lies too far from the map");
}

}  // namespace

void OccupancyGrid::insert(const RangeScan& scan, const Pose2& map_from_base, const LookMotion& motion) {
  if (!map_from_base.isFinite() || !scan.base_from_sensor.isFinite())
    throw InputError("pose of the range scan is not finite");
  requireRoomFor(map_from_base.translation(), geometry());
  if (!finite(scan))
    throw InputError("range scan: a beam is not finite or its interval is not around its range");
  if (std::none_of(scan.beams.begin(), scan.beams.end(), [](const Beam& beam) { return beam.hit; })) return;
  ScanWedge wedge(scan, map_from_base * scan.base_from_sensor, *this);
  wedge.apply(motion);
  ++version_;
  writeWindow(wedge.window());
  for (const SurfaceHit& hit : wedge.hits()) addHit(hit);
}

LookMotion motionBetween(const Pose2& map_from_before, const Pose2& map_from_now) {
  const Pose2 moved = map_from_before.inverse() * map_from_now;
  return {moved.translation().norm(), std::abs(moved.yaw_rad)};
}

double OccupancyGrid::newShare(double range_m, const LookMotion& motion) const {
  const double whole_m = params_.new_look_ratio * std::max(range_m, params_.resolution_m);
  return std::clamp(motion.moved_m / whole_m + motion.turned_rad / params_.new_look_rad,
                    params_.min_new_share, 1.0);
}

void OccupancyGrid::clear() {
  tiles_.clear();
  ++version_;
}

void OccupancyGrid::becomeRedrawn(OccupancyGrid&& redrawn) {
  for (const auto& [index, tile] : tiles_)
    redrawn.tileFor(index);  // what is no longer seen goes out as unseen
  tiles_ = std::move(redrawn.tiles_);
  low_ = redrawn.low_;
  high_ = redrawn.high_;
  ++version_;
  for (auto& [index, tile] : tiles_) tile.version = version_;
}

void OccupancyGrid::load(const GridMap& map) {
  const GridGeometry& from = map.geometry;
  if (std::abs(from.resolution_m - params_.resolution_m) > 1e-6)
    throw InputError("map to load: its resolution differs from the grid's resolution_m");
  // A map whose origin lies between cells is moved by less than half a cell.
  const Cell first{static_cast<int>(std::lround(from.origin_x_m / from.resolution_m)),
                   static_cast<int>(std::lround(from.origin_y_m / from.resolution_m))};
  clear();
  CellWindow window{from, first, {}};
  window.cells.reserve(map.occupied.total());
  for (int row = 0; row < from.rows; ++row)
    for (int col = 0; col < from.cols; ++col) {
      const double log_odds = EvidenceScale::logOddsOf(scale_.fromPublished(map.occupied(row, col)));
      window.cells.push_back(
          EvidenceScale::cellOf(std::clamp(log_odds, params_.min_log_odds, params_.max_log_odds)));
    }
  writeWindow(window);
}

GridGeometry OccupancyGrid::geometryOf(TileIndex low, TileIndex high) const {
  const Cell first = firstCellOf(low);
  return {params_.resolution_m, first.col * params_.resolution_m, first.row * params_.resolution_m,
          (high.col - low.col + 1) * kTileCells, (high.row - low.row + 1) * kTileCells};
}

OccupancyGrid::Tile& OccupancyGrid::tileFor(TileIndex index) {
  const auto found = tiles_.find(index);
  if (found != tiles_.end()) return found->second;
  low_ = tiles_.empty() ? index : TileIndex{std::min(low_.col, index.col), std::min(low_.row, index.row)};
  high_ = tiles_.empty() ? index : TileIndex{std::max(high_.col, index.col), std::max(high_.row, index.row)};
  return tiles_[index];
}

GridGeometry OccupancyGrid::geometry() const {
  if (tiles_.empty()) return {params_.resolution_m, 0, 0, 0, 0};
  return geometryOf(low_, high_);
}

GridMap OccupancyGrid::snapshot() const {
  if (tiles_.empty()) return {geometry(), cv::Mat1f()};
  return tiles(low_, high_);
}

GridMap OccupancyGrid::tile(TileIndex index) const { return tiles(index, index); }

bool OccupancyGrid::isSurface(const SurfacePoint& point, EvidenceCell cell) const {
  return point.weight > 0 && scale_.occupied(cell) >= kSurfaceOccupied;
}

GridMap OccupancyGrid::tiles(TileIndex low, TileIndex high) const {
  GridMap map{geometryOf(low, high), {}};
  map.occupied = cv::Mat1f(map.geometry.rows, map.geometry.cols, kUnseen);
  const Cell first = firstCellOf(low);
  for (int tile_row = low.row; tile_row <= high.row; ++tile_row) {
    const auto end = tiles_.upper_bound({high.col, tile_row});
    for (auto found = tiles_.lower_bound({low.col, tile_row}); found != end; ++found) {
      const Cell at = firstCellOf(found->first);
      for (int row = 0; row < kTileCells; ++row) {
        const EvidenceCell* cells = found->second.at({0, row});
        float* out = map.occupied.ptr<float>(at.row - first.row + row) + (at.col - first.col);
        for (int col = 0; col < kTileCells; ++col) out[col] = scale_.published(cells[col]);
      }
      const std::vector<EvidenceCell>& cells = found->second.cells;
      const std::vector<SurfacePoint>& surface = found->second.surface;
      for (std::size_t i = 0; i < surface.size(); ++i)
        if (isSurface(surface[i], cells[i])) map.surface.push_back(surface[i]);
    }
  }
  return map;
}

std::vector<TileIndex> OccupancyGrid::changedTiles(std::uint64_t version) const {
  std::vector<TileIndex> changed;
  for (const auto& [index, tile] : tiles_)
    if (tile.version > version) changed.push_back(index);
  return changed;
}

CellWindow OccupancyGrid::readWindow(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m) const {
  const GridGeometry whole{params_.resolution_m, 0, 0, 0, 0};
  const Cell first = whole.cellAt(low_m), last = whole.cellAt(high_m);
  const double resolution_m = params_.resolution_m;
  CellWindow window{{resolution_m, first.col * resolution_m, first.row * resolution_m,
                     last.col - first.col + 1, last.row - first.row + 1},
                    first,
                    {}};
  window.cells.assign(
      static_cast<std::size_t>(window.geometry.cols) * static_cast<std::size_t>(window.geometry.rows),
      EvidenceCell{0});
  forEachRowPart(window, [&](TileIndex index, Cell inside, Cell at, int count) {
    const auto found = tiles_.find(index);
    if (found != tiles_.end()) std::copy_n(found->second.at(inside), count, &window.at(at));
  });
  return window;
}

void OccupancyGrid::writeWindow(const CellWindow& window) {
  forEachRowPart(window, [&](TileIndex index, Cell inside, Cell at, int count) {
    const EvidenceCell* cells = &window.cells[window.indexOf(at)];
    const auto found = tiles_.find(index);
    const bool known = found != tiles_.end();
    if (!known && std::all_of(cells, cells + count, [](EvidenceCell cell) { return cell == 0; })) return;
    Tile& tile = known ? found->second : tileFor(index);
    EvidenceCell* old_cells = tile.at(inside);
    if (std::equal(cells, cells + count, old_cells)) return;
    std::copy_n(cells, count, old_cells);
    tile.version = version_;
  });
}

void OccupancyGrid::addHit(const SurfaceHit& hit) {
  const TileIndex index = tileOf(hit.cell);
  const auto found = tiles_.find(index);
  if (found == tiles_.end()) return;
  Tile& tile = found->second;
  if (tile.surface.empty()) tile.surface.resize(kTileCells * kTileCells);
  const Cell first = firstCellOf(index);
  SurfacePoint& point = tile.surface[static_cast<std::size_t>((hit.cell.row - first.row) * kTileCells +
                                                              hit.cell.col - first.col)];
  // What is being cleared is forgotten, so that a thing put there later has its own place.
  if (EvidenceScale::logOddsOf(*tile.at({hit.cell.col - first.col, hit.cell.row - first.row})) < 0)
    point.weight = 0;
  const double gain = hit.weight / (hit.weight + static_cast<double>(point.weight));
  point.x_m += static_cast<float>(gain * (hit.point_m.x() - static_cast<double>(point.x_m)));
  point.y_m += static_cast<float>(gain * (hit.point_m.y() - static_cast<double>(point.y_m)));
  point.weight = std::min(kMaxSurfaceWeight, point.weight + static_cast<float>(hit.weight));
}

std::vector<SurfacePoint> OccupancyGrid::readSurface(const CellWindow& window) const {
  std::vector<SurfacePoint> surface(window.cells.size());
  forEachRowPart(window, [&](TileIndex index, Cell inside, Cell at, int count) {
    const auto found = tiles_.find(index);
    if (found == tiles_.end() || found->second.surface.empty()) return;
    const SurfacePoint* points =
        found->second.surface.data() + static_cast<std::ptrdiff_t>(inside.row * kTileCells + inside.col);
    const std::size_t start = window.indexOf(at);
    for (int i = 0; i < count; ++i) {
      const std::size_t to = start + static_cast<std::size_t>(i);
      if (isSurface(points[i], window.cells[to])) surface[to] = points[i];
    }
  });
  return surface;
}

}  // namespace cornerstone
