#include "cornerstone/scan/column_scan.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "support/room.h"

namespace cornerstone {
namespace {

using test::levelCamera;
using test::rigOf;

// f B = 0.06 px m a column, 9.6 at 160: a wall at 3 m fills that image with 3.2 px.
Disparity flat(float disparity_px, float sigma_px, int cols = 160) {
  Disparity disparity;
  disparity.rig = rigOf(cols);
  disparity.disparity_px = cv::Mat1f(cols * 3 / 4, cols, disparity_px);
  disparity.sigma_px = cv::Mat1f(cols * 3 / 4, cols, sigma_px);
  disparity.rejection = cv::Mat1b::zeros(cols * 3 / 4, cols);
  return disparity;
}

const Beam& middle(const RangeScan& scan) { return scan.beams[scan.beams.size() / 2]; }

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

// What a camera on a robot sees of the floor and of a wall across at wall_m, without noise. base_from_camera
// as it is, not as the robot thinks.
Disparity floorAndWall(const Eigen::Isometry3d& base_from_camera, double wall_m, int cols = 160) {
  Disparity disparity = flat(0, 0.2F, cols);
  const TrinocularRig& rig = disparity.rig;
  for (int v = 0; v < cols * 3 / 4; ++v)
    for (int u = 0; u < cols; ++u) {
      const Eigen::Vector3d ray =
          base_from_camera.linear() *
          Eigen::Vector3d((u - rig.centre_x_px) / rig.focal_px, (v - rig.centre_y_px) / rig.focal_px, 1);
      double inverse_depth = std::max(0.0, ray.x() / (wall_m - base_from_camera.translation().x()));
      inverse_depth = std::max(inverse_depth, -ray.z() / base_from_camera.translation().z());
      disparity.disparity_px(v, u) = static_cast<float>(rig.focal_px * rig.baseline_m * inverse_depth);
    }
  return disparity;
}

Eigen::Isometry3d pitchedDown(double pitch_deg) {
  Eigen::Isometry3d level_from_base = Eigen::Isometry3d::Identity();
  level_from_base.rotate(Eigen::AngleAxisd(pitch_deg * M_PI / 180, Eigen::Vector3d::UnitY()));
  return level_from_base;
}

// The wall is 6 m away; a robot that pitches 3 degrees down without knowing it takes the floor 2.9 m ahead to
// be 0.15 m high.
TEST(ColumnScan, TheFloorBeforeAPitchedRobotIsNoWall) {
  Eigen::Isometry3d level = levelCamera();
  level.translation().z() = 1;
  const Eigen::Isometry3d camera = pitchedDown(3) * level;
  const Disparity seen = floorAndWall(camera, 8, 640);
  const auto nearest_m = [](const RangeScan& scan) {
    double nearest = 1e9;
    for (const Beam& beam : scan.beams)
      if (beam.hit) nearest = std::min(nearest, beam.range_m * std::cos(beam.bearing_rad));
    return nearest;
  };
  const RangeScan known = scanFromDisparity(seen, camera, {}), unknown = scanFromDisparity(seen, level, {});
  EXPECT_NEAR(nearest_m(known), 8 - camera.translation().x(), 0.05);
  EXPECT_NEAR(middle(known).range_m, 8 - camera.translation().x(), 0.05);
  EXPECT_LT(nearest_m(unknown), 6) << "the test would see nothing";
  // Half a degree that nobody knows of is within tilt_sigma_deg.
  const RangeScan braking = scanFromDisparity(floorAndWall(pitchedDown(0.6) * level, 8, 640), level, {});
  EXPECT_GT(nearest_m(braking), 7.5);
}

// A bumper 0.3 m before the base's origin, seen by a camera 0.1 m before it; the wall behind it stays.
TEST(ColumnScan, TheRobotsOwnBodyIsNoObstacle) {
  Eigen::Isometry3d camera = levelCamera();
  camera.translation().x() = 0.1;
  Disparity disparity = floorAndWall(camera, 3);
  disparity.disparity_px(cv::Rect(0, 90, 160, 30)) = static_cast<float>(9.6 / 0.2);
  ScanParams params;
  params.min_range_m = 0.05;
  params.body_radius_m = 0.15;
  EXPECT_NEAR(middle(scanFromDisparity(disparity, camera, params)).range_m, 0.2, 0.01);
  params.body_radius_m = 0.45;  // the bumper's ends lie 0.36 m from the origin
  const RangeScan scan = scanFromDisparity(disparity, camera, params);
  for (const Beam& beam : scan.beams) {
    ASSERT_TRUE(beam.hit);
    EXPECT_NEAR(beam.range_m * std::cos(beam.bearing_rad), 2.9, 0.02);
  }
}

// A cupboard 1.4 m high at 3 m before a wall at 4 m: the near-ceiling level sees the wall over it.
TEST(ColumnScan, LevelsAreReadFromOneImage) {
  Disparity disparity = floorAndWall(levelCamera(), 4);
  disparity.sigma_px.setTo(0.05);
  for (int v = 0; v < 120; ++v) {
    const double height_m = 0.4 - (v - 59.5) / 80 * 3;
    if (height_m > 0 && height_m < 1.4) disparity.disparity_px.row(v) = 3.2F;
  }
  ScanParams params, alone;
  params.levels.push_back({"ceiling", 1.7, 2.4});
  alone.levels = {params.levels[1]};
  const RangeScan scan = scanFromDisparity(disparity, levelCamera(), params);
  ASSERT_EQ(scan.further_levels.size(), 1U);
  EXPECT_NEAR(middle(scan).range_m, 3, 0.02);
  EXPECT_NEAR(middle(levelOf(scan, 1)).range_m, 4, 0.03);
  // Each level is what a scan of it alone would be.
  const RangeScan ceiling = scanFromDisparity(disparity, levelCamera(), alone),
                  first = scanFromDisparity(disparity, levelCamera(), {});
  for (std::size_t i = 0; i < 160; ++i) {
    EXPECT_EQ(ceiling.beams[i].range_m, scan.further_levels[0][i].range_m);
    EXPECT_EQ(first.beams[i].range_m, scan.beams[i].range_m);
  }
  EXPECT_TRUE(levelOf(scan, 2).beams.empty());
}

TEST(ColumnScan, BadLevelsAreRefusedByName) {
  const auto refusal = [](const std::vector<Level>& levels) -> std::string {
    ScanParams params;
    params.levels = levels;
    try {
      requireValid(params);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const Level good{"obstacles", 0.15, 1.5};
  EXPECT_EQ(refusal({good, {"ceiling_2", 1.7, 2.4}}), "");
  EXPECT_NE(refusal({}).find("levels: at least one"), std::string::npos);
  EXPECT_NE(refusal({good, {"Two words", 1, 2}}).find("levels[1]/name is 'Two words'"), std::string::npos);
  EXPECT_NE(refusal({{"", 1, 2}}).find("levels[0]/name"), std::string::npos);
  EXPECT_NE(refusal({good, good}).find("'obstacles' is there twice"), std::string::npos);
  EXPECT_NE(refusal({good, {"a", 2, 1}}).find("levels[1]/z_max_m above z_min_m"), std::string::npos);
  EXPECT_NE(refusal({good, {"a", NAN, 1}}).find("levels[1]/z_min_m"), std::string::npos);
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
  params.levels.front().z_max_m = 0;
  EXPECT_THROW(scanFromDisparity(flat(3, 0.1F), levelCamera(), params), InputError);
  Eigen::Isometry3d bad = levelCamera();
  bad.translation().x() = NAN;
  EXPECT_THROW(scanFromDisparity(flat(3, 0.1F), bad, {}), InputError);
}

}  // namespace
}  // namespace cornerstone
