// The occupancy grid of one local frame. It is kept in tiles of MRPT's log-odds cells, so that it grows
// without copying and the cost of a scan does not depend on the size of the map. (A whole COccupancyGridMap2D
// a tile would weigh 770 kB instead of 4: it holds room for a Voronoi diagram, too.)
//
// A look is inserted by Bayes' rule over the whole beam (beam_evidence.h): the surface that was measured is
// one of the cells in the beam's interval; the map so far says which. A wall that was seen sharply from near
// takes the evidence of later far looks to itself, so these neither smear nor erase it.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/evidence.h"
#include "cornerstone/mapping/grid_map.h"
#include "cornerstone/mapping/tile_index.h"
#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

struct GridParams {
  double resolution_m = 0.05;  // edge of a cell
  double max_range_m = 8;      // beams say nothing farther away
  // Beams less certain only clear the space before their interval. Two cells: what is seen more vaguely would
  // be drawn beside the surface. Stereo of 160 x 120 pixels reaches 4 m with it, of 320 x 240 6 m.
  double max_sigma_m = 0.10;
  double prior_occupied =
      0.03;  // share of the cells along a line of sight that hold a surface (one in about 30)
  double outlier_ratio = 0.05;  // share of beams that are mismatches and say nothing
  double free_step =
      1.0;  // largest log-odds one look takes from a cell: a box that goes is free after 10 looks
  double occupied_step =
      3.0;  // largest log-odds one look adds to a cell: a new obstacle is there after 2 looks
  double min_log_odds = -3;  // evidence is held within these, so that the map stays able to change
  double max_log_odds = 7;
  // Stereo repeats its errors when it looks again from the same place. A look counts in full when the sensor
  // has moved by this share of the distance to what it sees, or turned by this angle, and by its part of that
  // before; at least by the last of these.
  double new_look_ratio = 0.1;
  double new_look_rad = 0.26;
  double min_new_share = 0.1;
};
void describe(ParamVisitor& visitor, GridParams& params);

// How far the sensor has moved since the look before.
struct LookMotion {
  double moved_m = 0;
  double turned_rad = 0;
};
constexpr LookMotion kFirstLook{1e3, 0};
LookMotion motionBetween(const Pose2& map_from_before, const Pose2& map_from_now);

// A rectangle of cells read from the grid, for work that touches many of them.
struct CellWindow {
  GridGeometry geometry;  // cell (0, 0) of the window is `first` of the grid
  Cell first;
  std::vector<EvidenceCell> cells;  // row by row
  EvidenceCell& at(Cell cell) { return cells[indexOf(cell)]; }
  EvidenceCell at(Cell cell) const { return cells[indexOf(cell)]; }
  std::size_t indexOf(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(geometry.cols) +
           static_cast<std::size_t>(cell.col);
  }
};

struct SurfaceHit {
  Cell cell;  // of the grid
  Eigen::Vector2d point_m;
  double weight = 0;
};

class OccupancyGrid {
 public:
  explicit OccupancyGrid(const GridParams& params);  // throws InputError naming a parameter out of range
  // What a look confirms counts by how new it is (GridParams); what contradicts the map always counts in
  // full.
  void insert(const RangeScan& scan, const Pose2& map_from_base, const LookMotion& motion = kFirstLook);
  // How much of a look at something this far away is new.
  double newShare(double range_m, const LookMotion& motion) const;
  void load(const GridMap& map);  // replaces all; throws InputError when the resolution or alignment differs
  void clear();
  // Becomes another grid of the same cells; every tile of both counts as changed.
  void becomeRedrawn(OccupancyGrid&& redrawn);

  bool empty() const { return tiles_.empty(); }
  std::uint64_t version() const { return version_; }  // rises with every change
  GridGeometry geometry() const;                      // all tiles; 0 x 0 cells when empty
  GridMap snapshot() const;                           // of geometry()
  // Tiles with cells changed after `version` (0: all), in a fixed order. Their surface goes with them.
  std::vector<TileIndex> changedTiles(std::uint64_t version) const;
  GridMap tile(TileIndex index) const;  // kTileCells x kTileCells; kUnseen where there is nothing
  // The tiles from low to high, both included, as one map with its surface.
  GridMap tiles(TileIndex low, TileIndex high) const;

  const GridParams& params() const { return params_; }
  const EvidenceScale& scale() const { return scale_; }
  CellWindow readWindow(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m) const;
  // Surface points of a window's occupied cells, row by row; weight 0 elsewhere.
  std::vector<SurfacePoint> readSurface(const CellWindow& window) const;

 private:
  struct Tile {
    std::vector<EvidenceCell> cells = std::vector<EvidenceCell>(kTileCells * kTileCells, EvidenceCell{0});
    std::vector<SurfacePoint> surface;  // empty until the first hit
    std::uint64_t version = 0;
    EvidenceCell* at(Cell cell) {
      return cells.data() + cell.row * kTileCells + cell.col;
    }  // within the tile
    const EvidenceCell* at(Cell cell) const { return cells.data() + cell.row * kTileCells + cell.col; }
  };
  Tile& tileFor(TileIndex index);
  void writeWindow(const CellWindow& window);
  void addHit(const SurfaceHit& hit);
  bool isSurface(const SurfacePoint& point, EvidenceCell cell) const;
  GridGeometry geometryOf(TileIndex low, TileIndex high) const;

  GridParams params_;
  EvidenceScale scale_;
  std::map<TileIndex, Tile> tiles_;
  TileIndex low_, high_;  // the rectangle that the tiles span
  std::uint64_t version_ = 0;
};

}  // namespace cornerstone
