#include "cornerstone/mapping/frame_match.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numeric>
#include <random>

#include "support/room_scan.h"

namespace cornerstone {
namespace {

KeyFrame frameAt(const Pose2& pose, const ScanCalibration& needed = {}) {
  return makeKeyFrame(test::scanOf(test::officeRoom(), pose, needed), pose, pose, {});
}

// What the match's quadratic says of a motion and a calibration: 0 at what it holds for true.
double lengthAt(const FrameMatch& match, const Pose2& motion, const ScanCalibration& calibration) {
  Vector5d at;
  at << motion.x_m - match.earlier_from_later.x_m, motion.y_m - match.earlier_from_later.y_m,
      wrapAngle(motion.yaw_rad - match.earlier_from_later.yaw_rad), calibration.offset_per_m,
      calibration.slope_per_m;
  return (match.sqrt_information * at + match.offset).norm();
}

TEST(KeyFrame, PiecesLieOnTheWallsTheySee) {
  const test::Room room = test::officeRoom();
  const Pose2 pose{2, 2, 0.7};
  const KeyFrame frame = frameAt(pose);
  int valid = 0, near = 0;
  for (const WallPiece& piece : frame.pieces) {
    if (!piece.valid) continue;
    ++valid;
    near += room.distanceTo(pose * piece.point_m) < 0.02;
    EXPECT_NEAR(piece.normal.norm(), 1, 1e-9);
  }
  EXPECT_GT(valid, 80);
  EXPECT_GT(near, 0.95 * valid);  // some bend round a corner
}

TEST(FrameMatch, FindsTheMotionBetweenTwoLooks) {
  const Pose2 before{2, 2, 0.7}, after{2.3, 2.25, 0.85};
  const Pose2 truth = before.inverse() * after;
  const Pose2 guess{truth.x_m + 0.08, truth.y_m - 0.06, truth.yaw_rad + 0.03};
  const auto match = matchFrames(frameAt(before), frameAt(after), {guess, {}}, {});
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->earlier_from_later.x_m, truth.x_m, 0.005);
  EXPECT_NEAR(match->earlier_from_later.y_m, truth.y_m, 0.005);
  EXPECT_NEAR(match->earlier_from_later.yaw_rad, truth.yaw_rad, 0.004);
}

// Walls seen from near and far tell the offset: at the needed calibration the true motion is far better than
// without it.
TEST(FrameMatch, KnowsHowTheMotionHangsOnTheCalibration) {
  const ScanCalibration needed{0.005, 0.003};  // 0.05 and 0.03 px over f B = 9.6 px m
  const Pose2 before{1.2, 2.2, 0.3}, after{3.2, 2.4, 0.2};
  const Pose2 truth = before.inverse() * after;
  const auto match = matchFrames(frameAt(before, needed), frameAt(after, needed), {truth, {}}, {});
  ASSERT_TRUE(match);
  EXPECT_LT(lengthAt(*match, truth, needed), 0.5 * lengthAt(*match, truth, {}));
  EXPECT_LT(lengthAt(*match, truth, needed), 1);
}

// Noise that is even in the inverse range must not pass for a calibration: taken at the ranges as measured,
// derivatives hang on the noise that they are multiplied with. Poses are known here; 300 matches together.
TEST(FrameMatch, NoiseIsNoCalibration) {
  test::Room room;
  room.addRectangle(0, 0, 5, 4);
  std::mt19937 random(7);
  std::normal_distribution<double> noise_per_m(0, 0.012);  // 0.12 px over f B = 9.6 px m
  const auto noisyFrame = [&](const Pose2& pose) {
    RangeScan scan = test::scanOf(room, pose);
    constexpr std::size_t kWindow = 9;  // of matching: neighbours share most of their error
    std::vector<double> each_per_m(scan.beams.size() + kWindow);
    for (double& value : each_per_m) value = noise_per_m(random) / std::sqrt(kWindow);
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const auto first = each_per_m.begin() + static_cast<std::ptrdiff_t>(i);
      const double error_per_m = std::accumulate(first, first + kWindow, 0.0);
      Beam& beam = scan.beams[i];
      if (!beam.hit) continue;
      beam.range_m = 1 / (1 / beam.range_m + error_per_m);
      beam.sigma_m = 0.012 * beam.range_m * beam.range_m;
    }
    return makeKeyFrame(scan, pose, pose, {});
  };
  const Pose2 before{1.2, 2.2, 0.3}, after{1.6, 2.3, 0.3};
  const Pose2 truth = before.inverse() * after;
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (int i = 0; i < 300; ++i) {
    const auto match = matchFrames(noisyFrame(before), noisyFrame(after), {truth, {}}, {});
    if (!match) continue;
    const Pose2& at = match->earlier_from_later;
    const Eigen::Vector3d off(truth.x_m - at.x_m, truth.y_m - at.y_m, wrapAngle(truth.yaw_rad - at.yaw_rad));
    const Vector5d residual = match->sqrt_information.leftCols<3>() * off + match->offset;
    const auto by_calibration = match->sqrt_information.rightCols<2>();
    squares += by_calibration.transpose() * by_calibration;
    gradient += by_calibration.transpose() * residual;
  }
  const Eigen::Vector2d calibration = -squares.inverse() * gradient;
  EXPECT_LT(std::abs(calibration.x()), 0.010) << "1/m";  // taken as measured: 0.015
}

// A laser sees to 90 degrees on both sides, where a camera's calibration has no meaning.
TEST(FrameMatch, ALaserWithHalfACircleOfViewHasNoCalibrationInItsMatches) {
  const test::Room room = test::officeRoom();
  const auto frame = [&](const Pose2& pose) {
    RangeScan scan;
    for (int degree = -90; degree <= 90; ++degree) {
      Beam beam;
      beam.bearing_rad = degree * M_PI / 180;
      beam.width_rad = M_PI / 180;
      const auto range_m = room.rangeFrom(pose.translation(), pose.yaw_rad + beam.bearing_rad);
      beam.hit = range_m.has_value();
      beam.range_m = range_m.value_or(0);
      beam.sigma_m = 0.02;
      scan.beams.push_back(beam);
    }
    return makeKeyFrame(scan, pose, pose, {});
  };
  const Pose2 before{2, 2, 0.7}, after{2.2, 2.15, 0.8};
  const Pose2 truth = before.inverse() * after;
  const auto match = matchFrames(frame(before), frame(after), {truth, {}}, {});
  ASSERT_TRUE(match);
  EXPECT_EQ(match->sqrt_information.rightCols<2>().norm(), 0);
  EXPECT_LT(lengthAt(*match, truth, {}), 1);
  const Pose2 beside{truth.x_m + 0.1, truth.y_m, truth.yaw_rad};
  EXPECT_GT(lengthAt(*match, beside, {}), 2);  // the motion is known
}

TEST(FrameMatch, LooksAtOtherWallsDoNotMatch) {
  const auto match = matchFrames(frameAt({2, 2, 0.7}), frameAt({2, 2, -2.4}), {{0, 0, -3.1}, {}}, {});
  EXPECT_FALSE(match);
  EXPECT_FALSE(matchFrames(frameAt({2, 2, 0.7}), makeKeyFrame({}, {}, {}, {}), {}, {}));
}

// Along a bare corridor nothing is said, and the quadratic must not claim it.
TEST(FrameMatch, ABareCorridorLeavesItsAxisOpen) {
  test::Room corridor;
  corridor.walls = {{{-50, -1}, {50, -1}}, {{-50, 1}, {50, 1}}};
  const auto frame = [&](const Pose2& pose) {
    return makeKeyFrame(test::scanOf(corridor, pose), pose, pose, {});
  };
  const auto match = matchFrames(frame({0, 0, 0}), frame({0.4, 0.1, 0.05}), {{0.5, 0.1, 0.05}, {}}, {});
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->earlier_from_later.y_m, 0.1, 0.005);
  const Pose2 farther{match->earlier_from_later.x_m + 0.3, match->earlier_from_later.y_m,
                      match->earlier_from_later.yaw_rad};
  EXPECT_LT(lengthAt(*match, farther, {}), lengthAt(*match, match->earlier_from_later, {}) + 0.5);
}

}  // namespace
}  // namespace cornerstone
