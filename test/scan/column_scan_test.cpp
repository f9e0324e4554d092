#include "cornerstone/scan/column_scan.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "support/room.h"

namespace cornerstone {
namespace {

using test::levelCamera;
using test::rigOf;

// f B = 9.6 px m: a wall at 3 m fills the image with 3.2 px.
Disparity flat(float disparity_px, float sigma_px) {
  Disparity disparity;
  disparity.rig = rigOf(160);
  disparity.disparity_px = cv::Mat1f(120, 160, disparity_px);
  disparity.sigma_px = cv::Mat1f(120, 160, sigma_px);
  disparity.rejection = cv::Mat1b::zeros(120, 160);
  return disparity;
}

const Beam& middle(const RangeScan& scan) { return scan.beams[80]; }

TEST(ColumnScan, WallAcrossTheView) {
  const RangeScan scan = scanFromDisparity(flat(3.2F, 0.1F), levelCamera(), {});
  ASSERT_EQ(scan.beams.size(), 160U);
  EXPECT_NEAR(middle(scan).range_m, 3, 1e-3);
  EXPECT_LT(std::abs(middle(scan).bearing_rad), 1.0 / 80);
  EXPECT_NEAR(middle(scan).width_rad, 1.0 / 80, 1e-5);
  // The wall is a plane across the optical axis: 45 degrees aside it is 3 / cos 45 away.
  EXPECT_NEAR(scan.beams.back().range_m * std::cos(scan.beams.back().bearing_rad), 3, 1e-3);
  EXPECT_GT(scan.beams.back().bearing_rad, 0.77);  // rising bearing: the last beam looks left
  EXPECT_LT(scan.beams.front().bearing_rad, -0.77);
}

TEST(ColumnScan, IntervalIsTwoSigmaInDisparity) {
  const ScanParams params;
  const Beam beam = middle(scanFromDisparity(flat(3.2F, 0.3F), levelCamera(), params));
  const double sigma_px = (9.6 / beam.near_m - 3.2) / 2;
  EXPECT_NEAR(9.6 / beam.far_m, 3.2 - 2 * sigma_px, 1e-3);
  EXPECT_GT(sigma_px, params.common_sigma_px);  // averaging does not remove what all pixels share
  EXPECT_LT(sigma_px, 0.25);                    // but it does help
  EXPECT_NEAR(beam.sigma_m, sigma_px * 3 / 3.2, 1e-3);
}

TEST(ColumnScan, SinglePixelIsNoObstacle) {
  Disparity disparity = flat(3.2F, 0.1F);
  disparity.disparity_px(60, 80) = 20;
  const Beam beam = middle(scanFromDisparity(disparity, levelCamera(), {}));
  EXPECT_NEAR(beam.range_m, 3, 0.01);
  EXPECT_GT(beam.clear_m, 2.5);
}

TEST(ColumnScan, FewPixelsEndTheFreeSpaceButAreNoObstacle) {
  Disparity disparity = flat(3.2F, 0.1F);
  for (int v = 58; v < 62; ++v) disparity.disparity_px(v, 80) = 9.6F;  // 1 m, four pixels
  const RangeScan scan = scanFromDisparity(disparity, levelCamera(), {});
  const auto cautious = std::min_element(scan.beams.begin(), scan.beams.end(),
                                         [](auto& a, auto& b) { return a.clear_m < b.clear_m; });
  EXPECT_NEAR(cautious->range_m, 3, 0.01);
  EXPECT_LE(cautious->clear_m, 1.0);
}

TEST(ColumnScan, NearestSurfaceWins) {
  Disparity disparity = flat(3.2F, 0.1F);
  disparity.disparity_px(cv::Rect(70, 50, 20, 20)) = 9.6F;  // a box at 1 m, 0.25 m high
  EXPECT_NEAR(middle(scanFromDisparity(disparity, levelCamera(), {})).range_m, 1, 0.01);
}

TEST(ColumnScan, NoAnswerStaysEmpty) {
  Disparity disparity = flat(3.2F, 0.1F);
  disparity.disparity_px(cv::Rect(60, 0, 40, 120)) = 0;
  const RangeScan scan = scanFromDisparity(disparity, levelCamera(), {});
  EXPECT_FALSE(middle(scan).hit);
  EXPECT_EQ(middle(scan).clear_m, 0);
  EXPECT_TRUE(scan.beams.front().hit);
}

// Floor, ceiling and noise, no walls: at most a stray far answer, which the grid takes as next to nothing.
TEST(ColumnScan, FloorAndCeilingAreNoObstacles) {
  std::mt19937 random(1);
  test::DisparityNoise noise;
  noise.answered_share = 1;
  noise.mismatch_share = 0;
  int hits = 0;
  for (int look = 0; look < 20; ++look) {
    const auto disparity = disparityOf(test::Room{}, {}, rigOf(160), noise, random);
    for (const Beam& beam : scanFromDisparity(disparity, levelCamera(), {}).beams) {
      hits += beam.hit;
      if (beam.hit) {
        EXPECT_GT(beam.range_m, 5);
      }
    }
  }
  EXPECT_LT(hits, 20 * 160 / 50);
}

// Pitched 15 degrees down: the wall's pixels have other disparities row by row, its distance on the floor is
// one.
TEST(ColumnScan, PitchedCamera) {
  Eigen::Isometry3d base_from_camera = levelCamera();
  base_from_camera.rotate(Eigen::AngleAxisd(-15 * M_PI / 180, Eigen::Vector3d::UnitX()));
  Disparity disparity = flat(0, 0.1F);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 160; ++u) {
      const Eigen::Vector3d ray =
          base_from_camera.linear() * Eigen::Vector3d((u - 79.5) / 80, (v - 59.5) / 80, 1);
      disparity.disparity_px(v, u) = static_cast<float>(9.6 * ray.x() / 2);  // plane x = 2 m
    }
  const RangeScan scan = scanFromDisparity(disparity, base_from_camera, {});
  EXPECT_NEAR(scan.base_from_sensor.yaw_rad, 0, 1e-9);
  for (const Beam& beam : scan.beams)
    if (beam.hit) {
      EXPECT_NEAR(beam.range_m * std::cos(beam.bearing_rad), 2, 0.01);
    }
  EXPECT_TRUE(middle(scan).hit);
}

TEST(ColumnScan, ResolutionsAgree) {
  std::mt19937 random(2);
  const test::Room room = test::officeRoom();
  test::DisparityNoise exact{0.02, 1, 0};
  for (const int cols : {160, 320, 640}) {
    const auto disparity = disparityOf(room, {3, 3, 0}, rigOf(cols), exact, random);
    const RangeScan scan = scanFromDisparity(disparity, levelCamera(), {});
    EXPECT_NEAR(scan.beams[scan.beams.size() / 2].range_m, 3, 0.03) << cols;
  }
}

TEST(ColumnScan, RefusesBadInput) {
  Disparity disparity = flat(3, 0.1F);
  disparity.rig.baseline_m = -0.1;
  EXPECT_THROW(scanFromDisparity(disparity, levelCamera(), {}), InputError);
  ScanParams params;
  params.z_max_m = 0;
  EXPECT_THROW(scanFromDisparity(flat(3, 0.1F), levelCamera(), params), InputError);
  Eigen::Isometry3d bad = levelCamera();
  bad.translation().x() = NAN;
  EXPECT_THROW(scanFromDisparity(flat(3, 0.1F), bad, {}), InputError);
}

}  // namespace
}  // namespace cornerstone
