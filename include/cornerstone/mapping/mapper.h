// Scans and odometry in, a map and the drift of the odometry out: each scan is fitted to the map before it is
// inserted.
#pragma once

#include "cornerstone/mapping/occupancy_grid.h"

namespace cornerstone {

struct MapperParams {
  GridParams grid;
  // (the owner of this area adds the rest, each with unit and reason)
};
void describe(ParamVisitor& visitor, MapperParams& params);

struct MapperUpdate {
  Pose2 map_from_odom;
  bool inserted = false;  // false: the scan said nothing or did not fit
};

class Mapper {
 public:
  explicit Mapper(const MapperParams& params);
  // odom_from_base: at the scan's instant; not finite: InputError and nothing changes.
  MapperUpdate update(const RangeScan& scan, const Pose2& odom_from_base);
  const OccupancyGrid& grid() const { return grid_; }
  const Pose2& mapFromOdom() const { return map_from_odom_; }

 private:
  MapperParams params_;
  OccupancyGrid grid_;
  Pose2 map_from_odom_;
};

}  // namespace cornerstone
