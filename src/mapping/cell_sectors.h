// Which part of a table over the bearing each cell of a grid covers, as seen from a sensor. Rows are worked
// out as a whole, some cells at once: one by one, this would take most of the time of a scan.
#pragma once

#include <vector>

#include "cornerstone/base/grid_geometry.h"
#include "cornerstone/base/pose2.h"

namespace cornerstone {

struct BearingTable {
  double start_rad = 0;  // of its first entry, in the sensor's frame
  double step_rad = 1;
  int size = 0;
};

class CellSectors {
 public:
  CellSectors(const GridGeometry& grid, const Pose2& grid_from_sensor, const BearingTable& table);
  // Looks at the cells of a row that are no farther away than reach_m; they lie in the columns returned.
  struct Columns {
    int begin = 0, end = 0;
  };
  Columns look(int row, double reach_m);

  // Of a cell of the row that was looked at. The sector is that of the cell's middle where it covers three
  // entries at most. It may lie outside the table: then the cell is not wholly in view.
  float range_m(int col) const { return range_m_[index(col)]; }
  int first(int col) const { return first_[index(col)]; }
  int last(int col) const { return last_[index(col)]; }

 private:
  static std::size_t index(int col) { return static_cast<std::size_t>(col); }

  GridGeometry grid_;
  Eigen::Vector2d sensor_m_;
  Eigen::Vector2f ahead_, left_;
  BearingTable table_;
  std::vector<float> to_right_m_;  // from the sensor to each column
  std::vector<float> range_m_;
  std::vector<int> first_, last_;
};

}  // namespace cornerstone
