#include "cornerstone/scan/scan_calibration.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

RangeScan oneBeam(double bearing_rad, double range_m) {
  RangeScan scan;
  Beam beam;
  beam.bearing_rad = bearing_rad;
  beam.width_rad = 0.01;
  beam.hit = true;
  beam.range_m = range_m;
  beam.sigma_m = 0.02;
  beam.near_m = beam.clear_m = range_m - 0.04;
  beam.far_m = range_m + 0.04;
  scan.beams.push_back(beam);
  return scan;
}

TEST(ScanCalibration, AddsToTheInverseRange) {
  // Straight ahead at 2 m: 1/2 + 0.1 = 0.6.
  EXPECT_NEAR(corrected(oneBeam(0, 2), {0.1, 0.3}).beams[0].range_m, 1 / 0.6, 1e-9);
  // At 45 degrees: 1/2 + (0.1 * 2 + 0.05 * 1) * 0.7071.
  const Beam beam = corrected(oneBeam(M_PI / 4, 2), {0.1, 0.05}).beams[0];
  EXPECT_NEAR(beam.range_m, 1 / (0.5 + 0.25 * std::sqrt(0.5)), 1e-9);
  EXPECT_LT(beam.near_m, beam.range_m);
  EXPECT_GT(beam.far_m, beam.range_m);
}

TEST(ScanCalibration, TheDerivativeIsThatOfTheCorrection) {
  for (const double bearing_rad : {-0.6, 0.0, 0.4}) {
    const Eigen::Vector2d by = rangeByCalibration(3, bearing_rad);
    constexpr double kStep = 1e-6;
    const double offset = corrected(oneBeam(bearing_rad, 3), {kStep, 0}).beams[0].range_m;
    const double slope = corrected(oneBeam(bearing_rad, 3), {0, kStep}).beams[0].range_m;
    EXPECT_NEAR(by(0), (offset - 3) / kStep, 1e-3);
    EXPECT_NEAR(by(1), (slope - 3) / kStep, 1e-3);
  }
}

TEST(ScanCalibration, BeamsThatWouldLieAtInfinityLoseTheirAnswer) {
  const Beam beam = corrected(oneBeam(0.1, 5), {-0.21, 0}).beams[0];
  EXPECT_FALSE(beam.hit);
  EXPECT_EQ(beam.bearing_rad, 0.1);
  EXPECT_EQ(beam.range_m, 0);
}

}  // namespace
}  // namespace cornerstone
