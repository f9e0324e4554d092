// One look of a range sensor in the plane: a beam per image column (or laser ray), in the sensor's planar
// frame. A beam without an answer says nothing at all: it is never "free to the end".
#pragma once

#include <vector>

#include "cornerstone/base/pose2.h"

namespace cornerstone {

struct Beam {
  double bearing_rad = 0;  // in the sensor's planar frame: x forward, counter-clockwise
  double width_rad = 0;    // angle between the beam's edges
  bool hit = false;        // false: no answer, the fields below are 0
  double range_m = 0;      // to the obstacle, along the bearing
  double near_m = 0;       // interval of uncertainty around range_m, 2 sigma each side: the paper's Fig. 2e
  double far_m = 0;
  double sigma_m = 0;  // standard deviation of range_m
  double clear_m = 0;  // free up to here, <= near_m
};

struct RangeScan {
  Pose2 base_from_sensor;
  std::vector<Beam> beams;  // rising bearing; of the level that robots drive by
  // What the same look shows in further height bands (column_scan.h), beams as above; lasers have none.
  std::vector<std::vector<Beam>> further_levels;
  double correlated_beams = 1;  // neighbours that share one error (stereo: the correlation window's width)
  // Standard deviation, 1/m, of the error that the inverse depths of all looks of this sensor share
  // (scan_calibration.h); 0: none is known of.
  double calibration_sigma_per_m = 0;
};

// The look as a sensor of one level alone would have it; level 0 is `beams`, 1 the first of further_levels.
// Without beams where the look has no such level.
RangeScan levelOf(const RangeScan& scan, std::size_t level);

}  // namespace cornerstone
