// The occupancy grid of one local frame, on MRPT's log-odds grid; it grows as scans arrive.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <opencv2/core.hpp>

#include "cornerstone/base/params.h"
#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/grid_map.h"
#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

struct GridParams {
  double resolution_m = 0.05;
  // (the owner of this area adds the rest, each with unit and reason)
};
void describe(ParamVisitor& visitor, GridParams& params);

class OccupancyGrid {
 public:
  explicit OccupancyGrid(const GridParams& params);
  void insert(const RangeScan& scan, const Pose2& map_from_base);
  GridMap snapshot() const;
  void load(const GridMap& map);  // throws InputError when the resolution differs

 private:
  GridParams params_;
  mrpt::maps::COccupancyGridMap2D grid_;
};

}  // namespace cornerstone
