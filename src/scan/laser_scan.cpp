#include "cornerstone/scan/laser_scan.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

void answer(double range_m, const LaserParams& params, Beam& beam) {
  beam.hit = true;
  beam.range_m = range_m;
  beam.sigma_m = params.sigma_m;
  beam.near_m = std::max(0.0, range_m - 2 * params.sigma_m);
  beam.far_m = range_m + 2 * params.sigma_m;
  beam.clear_m = beam.near_m;
}

bool onBody(double range_m, double bearing_rad, const Pose2& base_from_sensor, const LaserParams& params) {
  const Eigen::Vector2d end_m(range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad));
  return (base_from_sensor * end_m).norm() < params.body_radius_m;
}

}  // namespace

void describe(ParamVisitor& visitor, LaserParams& params) {
  visitor.field("sigma_m", params.sigma_m);
  visitor.field("body_radius_m", params.body_radius_m);
}

RangeScan scanFromRanges(const LaserRanges& laser, const LaserParams& params) {
  requirePositive(params.sigma_m, "sigma_m");
  requireWithin(params.body_radius_m, 0, 10, "body_radius_m");
  requireFinite(laser.angle_min_rad, "angle_min of the laser scan");
  requirePositive(std::abs(laser.angle_increment_rad), "angle_increment of the laser scan");
  requireFinite(laser.range_min_m, "range_min of the laser scan");
  requirePositive(laser.range_max_m, "range_max of the laser scan");
  RangeScan scan;
  scan.base_from_sensor = laser.base_from_sensor;
  scan.beams.reserve(laser.ranges_m.size());
  for (std::size_t i = 0; i < laser.ranges_m.size(); ++i) {
    Beam beam;
    beam.bearing_rad = wrapAngle(laser.angle_min_rad + static_cast<double>(i) * laser.angle_increment_rad);
    beam.width_rad = std::abs(laser.angle_increment_rad);
    const double range_m = laser.ranges_m[i];
    // A range at range_max is what many drivers send for "nothing": no answer.
    const bool valid =
        std::isfinite(range_m) && range_m > 0 && range_m >= laser.range_min_m && range_m < laser.range_max_m;
    if (valid && !onBody(range_m, beam.bearing_rad, laser.base_from_sensor, params))
      answer(range_m, params, beam);
    scan.beams.push_back(beam);
  }
  std::stable_sort(scan.beams.begin(), scan.beams.end(),
                   [](const Beam& a, const Beam& b) { return a.bearing_rad < b.bearing_rad; });
  return scan;
}

}  // namespace cornerstone
