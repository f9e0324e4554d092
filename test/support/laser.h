// A planar laser that sees half a turn, and the mapper's parameters for it as they are shipped.
#pragma once

#include <stdexcept>

#include "cornerstone/base/params.h"
#include "cornerstone/mapping/mapper.h"
#include "cornerstone/scan/laser_scan.h"
#include "support/laid_over.h"
#include "support/room.h"

namespace cornerstone::test {

inline RangeScan laserScan(const Room& room, const Pose2& map_from_base) {
  LaserRanges laser;
  laser.angle_min_rad = -M_PI / 2;
  laser.angle_increment_rad = M_PI / 180;
  laser.range_max_m = 20;
  for (int i = 0; i <= 180; ++i)
    laser.ranges_m.push_back(static_cast<float>(
        room.rangeFrom(map_from_base.translation(), map_from_base.yaw_rad + (i - 90) * M_PI / 180)
            .value_or(0)));
  return scanFromRanges(laser, {});
}

inline MapperParams laserMapperParams() {
  const std::string config = std::string(CORNERSTONE_SOURCE_DIR) + "/config/";
  const YAML::Node whole = YAML::LoadFile(config + "mapper.yaml");
  if (!laidOver(whole, YAML::LoadFile(config + "mapper_laser.yaml")))
    throw std::runtime_error("mapper_laser.yaml has keys of its own");
  return readParams<MapperParams>(whole["mapper"], "mapper_laser.yaml");
}

}  // namespace cornerstone::test
