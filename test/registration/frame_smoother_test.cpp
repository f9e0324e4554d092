#include "cornerstone/registration/frame_smoother.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

const Eigen::Vector2d kCentre(5, 0);

TEST(FrameSmoother, ShowsTheFirstPoseAsItIsAndGlidesFromThere) {
  FrameSmoother smoother(0.5);
  EXPECT_NEAR(smoother.follow({1, 2, 0.3}, kCentre, 10).x_m, 1, 1e-12);
  // A step of 1 m after one time constant: 1 - 1/e of it.
  EXPECT_NEAR(smoother.follow({2, 2, 0.3}, kCentre, 10.5).x_m, 2 - std::exp(-1), 1e-12);
  EXPECT_NEAR(smoother.follow({2, 2, 0.3}, kCentre, 20).x_m, 2, 1e-6);
  smoother.reset();
  EXPECT_NEAR(smoother.follow({7, 2, 0.3}, kCentre, 20.1).x_m, 7, 1e-12);
}

TEST(FrameSmoother, ATurnAboutTheCentreLeavesItWhereItIs) {
  FrameSmoother smoother(1);
  const Pose2 first{1, 2, 3.1};
  const Eigen::Vector2d centre = smoother.follow(first, kCentre, 0) * kCentre;
  const Pose2 turn{0, 0, -3.1};  // across the seam at half a turn
  const Eigen::Vector2d origin = centre - turn.rotation() * kCentre;
  const Pose2 shown = smoother.follow({origin.x(), origin.y(), -3.1}, kCentre, 0.7);
  EXPECT_NEAR((shown * kCentre - centre).norm(), 0, 1e-12);
  EXPECT_GT(std::abs(shown.yaw_rad), 3.1);
}

TEST(FrameSmoother, WithoutATimeConstantItJumps) {
  FrameSmoother smoother(0);
  smoother.follow({0, 0, 0}, kCentre, 0);
  EXPECT_NEAR(smoother.follow({1, 0, 0}, kCentre, 0.01).x_m, 1, 1e-12);
}

}  // namespace
}  // namespace cornerstone
