#include "cornerstone/scan/scan_calibration.h"

#include <cmath>

namespace cornerstone {
namespace {

void correct(Beam& beam, const ScanCalibration& calibration) {
  const double change = calibration.offset_per_m / std::cos(beam.bearing_rad) +
                        calibration.slope_per_m * std::sin(beam.bearing_rad);
  constexpr double kLeastShare = 0.2;  // of the inverse range: what is left of it must still mean something
  const double kept = 1 + change * beam.range_m, kept_far = 1 + change * beam.far_m;
  if (kept < kLeastShare || kept_far < kLeastShare) {
    const Beam seen = beam;
    beam = Beam{};
    beam.bearing_rad = seen.bearing_rad;
    beam.width_rad = seen.width_rad;
    return;
  }
  beam.sigma_m /= kept * kept;
  beam.far_m /= kept_far;
  beam.near_m /= 1 + change * beam.near_m;
  beam.clear_m /= 1 + change * beam.clear_m;
  beam.range_m /= kept;
}

}  // namespace

Eigen::Vector2d rangeByCalibration(double range_m, double bearing_rad) {
  return -range_m * range_m * Eigen::Vector2d(1 / std::cos(bearing_rad), std::sin(bearing_rad));
}

RangeScan corrected(const RangeScan& scan, const ScanCalibration& calibration) {
  RangeScan result = scan;
  if (calibration.offset_per_m == 0 && calibration.slope_per_m == 0) return result;
  const auto correctAll = [&](std::vector<Beam>& beams) {
    for (Beam& beam : beams)
      if (beam.hit) correct(beam, calibration);
  };
  correctAll(result.beams);
  for (auto& level : result.further_levels) correctAll(level);
  return result;
}

}  // namespace cornerstone
