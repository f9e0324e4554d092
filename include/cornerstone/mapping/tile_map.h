// A grid map put together from square tiles as they arrive, of any extent: how one robot holds another
// robot's map.
#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

class TileMap {
 public:
  // Both must be positive: InputError otherwise.
  TileMap(double resolution_m, int tile_cells);
  // occupied: tile_cells x tile_cells; col, row: its first cell, in cells from the map frame's origin, a
  // multiple of tile_cells, so near the others that one map can hold them. InputError otherwise, and nothing
  // changes. surface: of its cells; empty: not known.
  void put(int col, int row, const cv::Mat1f& occupied, std::vector<SurfacePoint> surface = {});
  // All tiles as one map; what no tile covers was never seen. Empty map: no tile yet.
  GridMap assemble() const;
  double resolution() const { return resolution_m_; }
  int tileCells() const { return tile_cells_; }

 private:
  struct Tile {
    cv::Mat1f occupied;
    std::vector<SurfacePoint> surface;
  };
  void requireRoomFor(int tile_row, int tile_col) const;

  double resolution_m_;
  int tile_cells_;
  std::map<std::pair<int, int>, Tile> tiles_;  // by (row, col) in tiles
};

}  // namespace cornerstone
