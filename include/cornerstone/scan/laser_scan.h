// From the ranges of a planar laser to a range scan. Ranges that are not valid say nothing: a laser gives no
// answer for glass, black walls and the open alike. That holds for +inf, too, REP 117's "nothing within
// reach": what clears space is a surface that was seen, never its absence.
#pragma once

#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

struct LaserParams {
  double sigma_m = 0.02;       // of one range: usual for indoor lasers
  double body_radius_m = 0.2;  // beams that end this near to the base's origin show the robot itself
};
void describe(ParamVisitor& visitor, LaserParams& params);

struct LaserRanges {  // the meaning of sensor_msgs/LaserScan
  std::vector<float> ranges_m;
  double angle_min_rad = 0;
  double angle_increment_rad = 0;  // may be negative: a laser mounted upside down
  double range_min_m = 0;
  double range_max_m = 0;
  Pose2 base_from_sensor;
};

// Throws InputError when the increment is zero or a limit is not finite.
RangeScan scanFromRanges(const LaserRanges& laser, const LaserParams& params);

}  // namespace cornerstone
