// Where a grid lies in its frame: the only code that turns metres into cells and back.
//
//   y ^   row 2  +---+---+---+
//     |   row 1  +---+---+---+      Cell{col, row}; row 0 holds the smallest y, as in nav_msgs/OccupancyGrid.
//     |   row 0  +---+---+---+      Image files have their first row at the largest y: imageRow() flips.
//     |         col 0   1   2
//     +--(origin)-------------> x   origin: the outer corner of cell (0, 0), in metres
#pragma once

#include <Eigen/Core>

namespace cornerstone {

struct Cell {
  int col = 0;
  int row = 0;
  bool operator==(const Cell& other) const { return col == other.col && row == other.row; }
};

struct GridGeometry {
  double resolution_m = 0.05;  // edge of a cell
  double origin_x_m = 0;
  double origin_y_m = 0;
  int cols = 0;
  int rows = 0;

  bool contains(Cell cell) const {
    return cell.col >= 0 && cell.row >= 0 && cell.col < cols && cell.row < rows;
  }
  // The cell that holds a point; it may lie outside the grid.
  Cell cellAt(const Eigen::Vector2d& point_m) const;
  Eigen::Vector2d centreOf(Cell cell) const;
  // Continuous cell coordinates (col, row) in which whole numbers are cell centres, and back.
  Eigen::Vector2d toCells(const Eigen::Vector2d& point_m) const;
  Eigen::Vector2d toMetres(const Eigen::Vector2d& point_cells) const;
  // Row of an image file (first row at the largest y) for a grid row; its own inverse.
  int imageRow(int row) const { return rows - 1 - row; }
};

}  // namespace cornerstone
