// Which square piece of a map: tiles of kTileCells cells an edge, counted from the map frame's origin, so
// that a tile keeps its index however the map grows.
#pragma once

#include "cornerstone/base/grid_geometry.h"

namespace cornerstone {

constexpr int kTileCells = 64;

struct TileIndex {
  int col = 0;
  int row = 0;
  bool operator==(const TileIndex& other) const { return col == other.col && row == other.row; }
  bool operator<(const TileIndex& other) const {
    return row < other.row || (row == other.row && col < other.col);
  }
};

// Tile of a cell of the grid whose cell (0, 0) starts at the map frame's origin.
inline TileIndex tileOf(Cell cell) {
  const auto floorDiv = [](int value) {
    return value >= 0 ? value / kTileCells : -((-value + kTileCells - 1) / kTileCells);
  };
  return {floorDiv(cell.col), floorDiv(cell.row)};
}
inline Cell firstCellOf(TileIndex tile) { return {tile.col * kTileCells, tile.row * kTileCells}; }

}  // namespace cornerstone
