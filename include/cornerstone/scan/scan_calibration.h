// What a stereo rig gets wrong in every look alike, cameras turned against one another by a fraction of a
// pixel. Nothing in one look shows it; looks at the same wall from near and far do (mapping/frame_graph.h).
//
// A camera turned by e about its upright axis shifts column x by f e (1 + (x / f)^2); turned about the
// optical axis of the upper pair, by an amount that grows with x. With b a beam's bearing in the sensor
// frame, tan b = -x / f and 1/Z = q / cos b, the inverse range q becomes
//   q + (offset (1 + tan^2 b) + slope tan b) cos b
// For cameras only, whose views end well before 90 degrees.
#pragma once

#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

struct ScanCalibration {
  double offset_per_m = 0;  // of the inverse depth, 1/m: 0.1 px of disparity over f B
  double slope_per_m = 0;   // of the same, per unit of tan b
};

// d(range) / d(offset, slope) of a beam, m per 1/m.
Eigen::Vector2d rangeByCalibration(double range_m, double bearing_rad);

// The scan as the calibrated sensor had seen it. Beams that would lie behind the sensor or at infinity lose
// their answer.
RangeScan corrected(const RangeScan& scan, const ScanCalibration& calibration);

}  // namespace cornerstone
