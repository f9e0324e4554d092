#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "cornerstone/scan/depth_scan.h"
#include "cornerstone/scan/laser_scan.h"
#include "support/room.h"

namespace cornerstone {
namespace {

DepthImage depthOf(const cv::Mat& depth) { return {depth, 80, 79.5, 59.5}; }

TEST(DepthScan, MetresAndMillimetres) {
  const auto metres = scanFromDepth(depthOf(cv::Mat1f(120, 160, 2.5F)), {}, test::levelCamera(), {});
  const auto millimetres = scanFromDepth(depthOf(cv::Mat1w(120, 160, 2500)), {}, test::levelCamera(), {});
  EXPECT_NEAR(metres.beams[80].range_m, 2.5, 1e-3);
  EXPECT_NEAR(millimetres.beams[80].range_m, 2.5, 1e-3);
}

TEST(DepthScan, NanAndZeroSayNothing) {
  cv::Mat1f depth(120, 160, NAN);
  depth(cv::Rect(0, 0, 80, 120)) = 0;
  for (const Beam& beam : scanFromDepth(depthOf(depth), {}, test::levelCamera(), {}).beams)
    EXPECT_FALSE(beam.hit);
}

TEST(DepthScan, RefusesOtherTypes) {
  EXPECT_THROW(scanFromDepth(depthOf(cv::Mat1b(120, 160, uchar{1})), {}, test::levelCamera(), {}),
               InputError);
  EXPECT_THROW(scanFromDepth(depthOf({}), {}, test::levelCamera(), {}), InputError);
}

TEST(LaserScan, InvalidRangesSayNothing) {
  LaserRanges laser;
  laser.ranges_m = {1, NAN, INFINITY, 0, -1, 0.05F, 10, 2};
  laser.angle_min_rad = -0.4;
  laser.angle_increment_rad = 0.1;
  laser.range_min_m = 0.1;
  laser.range_max_m = 10;
  const RangeScan scan = scanFromRanges(laser, {});
  ASSERT_EQ(scan.beams.size(), 8U);
  EXPECT_TRUE(scan.beams[0].hit);
  for (std::size_t i = 1; i < 7; ++i) EXPECT_FALSE(scan.beams[i].hit) << i;
  EXPECT_NEAR(scan.beams[7].bearing_rad, 0.3, 1e-9);
  EXPECT_NEAR(scan.beams[7].range_m, 2, 1e-9);
}

// No return (+inf), too near (-inf), no reading (NaN): none says that anything is free.
TEST(LaserScan, TheRobotsOwnBodyAndInfinitiesSayNothing) {
  LaserRanges laser;
  laser.ranges_m = {INFINITY, -INFINITY, NAN, 0.25F, 0.4F, 2.0F};
  laser.angle_min_rad = -0.02;
  laser.angle_increment_rad = 0.01;
  laser.range_max_m = 8;
  laser.base_from_sensor = {-0.1, 0, 0};
  LaserParams params;
  params.body_radius_m = 0.2;
  const RangeScan scan = scanFromRanges(laser, params);
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(scan.beams[static_cast<std::size_t>(i)].hit) << i;
    EXPECT_EQ(scan.beams[static_cast<std::size_t>(i)].clear_m, 0) << i;
  }
  EXPECT_TRUE(scan.beams[4].hit);  // 0.3 m before the origin
  EXPECT_TRUE(scan.beams[5].hit);
}

TEST(LaserScan, UpsideDownStillRises) {
  LaserRanges laser{{1, 2, 3}, 0.1, -0.1, 0.1, 10, {}};
  const RangeScan scan = scanFromRanges(laser, {});
  EXPECT_NEAR(scan.beams[0].range_m, 3, 1e-6);
  EXPECT_NEAR(scan.beams[0].bearing_rad, -0.1, 1e-9);
  laser.angle_increment_rad = 0;
  EXPECT_THROW(scanFromRanges(laser, {}), InputError);
}

}  // namespace
}  // namespace cornerstone
