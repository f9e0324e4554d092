// Looks of a level camera with 90 degrees of view into a Room: exact ranges, or those of a rig whose inverse
// depths are off by a calibration.
#pragma once

#include "cornerstone/scan/scan_calibration.h"
#include "support/room.h"

namespace cornerstone::test {

// needed: what would have to be added to the inverse depths to make them right.
inline RangeScan scanOf(const Room& room, const Pose2& map_from_base, const ScanCalibration& needed = {}) {
  RangeScan scan;
  scan.calibration_sigma_per_m = 0.01;
  for (int i = -80; i < 80; ++i) {
    Beam beam;
    beam.bearing_rad = std::atan((i + 0.5) / 80);
    beam.width_rad = 1.0 / 80;
    const auto range_m =
        room.rangeFrom(map_from_base.translation(), map_from_base.yaw_rad + beam.bearing_rad);
    if (range_m && *range_m < 6) {
      beam.hit = true;
      beam.range_m = *range_m;
      beam.sigma_m = 0.005 + 0.008 * *range_m * *range_m;
      beam.near_m = beam.clear_m = *range_m - 2 * beam.sigma_m;
      beam.far_m = *range_m + 2 * beam.sigma_m;
    }
    scan.beams.push_back(beam);
  }
  return corrected(scan, {-needed.offset_per_m, -needed.slope_per_m});
}

}  // namespace cornerstone::test
