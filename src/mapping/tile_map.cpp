#include "cornerstone/mapping/tile_map.h"

#include <algorithm>
#include <climits>
#include <utility>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// More cells fit neither memory nor a message: 500 m x 500 m at 0.05 m. Such tiles come from damaged
// messages.
constexpr double kMostCells = 1e8;

}  // namespace

TileMap::TileMap(double resolution_m, int tile_cells) : resolution_m_(resolution_m), tile_cells_(tile_cells) {
  requirePositive(resolution_m, "tiles: resolution");
  requirePositive(tile_cells, "tiles: size");
}

void TileMap::put(int col, int row, const cv::Mat1f& occupied, std::vector<SurfacePoint> surface) {
  if (occupied.rows != tile_cells_ || occupied.cols != tile_cells_)
    throw InputError("tiles: a tile of another size");
  if (col % tile_cells_ != 0 || row % tile_cells_ != 0)
    throw InputError("tiles: a tile between the places of tiles");
  requireRoomFor(row / tile_cells_, col / tile_cells_);
  tiles_[{row / tile_cells_, col / tile_cells_}] = {occupied.clone(), std::move(surface)};
}

void TileMap::requireRoomFor(int tile_row, int tile_col) const {
  double first_row = tile_row, last_row = tile_row, first_col = tile_col, last_col = tile_col;
  for (const auto& [place, tile] : tiles_) {
    first_row = std::min<double>(first_row, place.first);
    last_row = std::max<double>(last_row, place.first);
    first_col = std::min<double>(first_col, place.second);
    last_col = std::max<double>(last_col, place.second);
  }
  const double tile_area = static_cast<double>(tile_cells_) * tile_cells_;
  if ((last_row - first_row + 1) * (last_col - first_col + 1) * tile_area > kMostCells)
    throw InputError("tiles: a tile too far from the others");
}

GridMap TileMap::assemble() const {
  GridMap map;
  map.geometry.resolution_m = resolution_m_;
  if (tiles_.empty()) return map;
  int first_row = INT_MAX, first_col = INT_MAX, last_row = INT_MIN, last_col = INT_MIN;
  for (const auto& [place, tile] : tiles_) {
    first_row = std::min(first_row, place.first);
    last_row = std::max(last_row, place.first);
    first_col = std::min(first_col, place.second);
    last_col = std::max(last_col, place.second);
  }
  map.geometry.cols = (last_col - first_col + 1) * tile_cells_;
  map.geometry.rows = (last_row - first_row + 1) * tile_cells_;
  map.geometry.origin_x_m = first_col * tile_cells_ * resolution_m_;
  map.geometry.origin_y_m = first_row * tile_cells_ * resolution_m_;
  map.occupied.create(map.geometry.rows, map.geometry.cols);
  map.occupied.setTo(kUnseen);
  for (const auto& [place, tile] : tiles_) {
    tile.occupied.copyTo(
        map.occupied(cv::Rect((place.second - first_col) * tile_cells_,
                              (place.first - first_row) * tile_cells_, tile_cells_, tile_cells_)));
    map.surface.insert(map.surface.end(), tile.surface.begin(), tile.surface.end());
  }
  return map;
}

}  // namespace cornerstone
