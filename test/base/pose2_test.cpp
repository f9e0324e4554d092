#include "cornerstone/base/pose2.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

TEST(Pose2, ComposesAndInverts) {
  const Pose2 a_from_b{1, 2, M_PI / 2};
  const Pose2 b_from_c{3, 0, M_PI / 2};
  const Pose2 a_from_c = a_from_b * b_from_c;  // 3 m along b's x axis, which is a's y axis
  EXPECT_NEAR(a_from_c.x_m, 1, 1e-12);
  EXPECT_NEAR(a_from_c.y_m, 5, 1e-12);
  EXPECT_NEAR(a_from_c.yaw_rad, M_PI, 1e-12);
  const Pose2 same = a_from_b.inverse() * a_from_c;
  EXPECT_NEAR(same.x_m, 3, 1e-12);
  EXPECT_NEAR(same.y_m, 0, 1e-12);
  EXPECT_NEAR(same.yaw_rad, M_PI / 2, 1e-12);
}

TEST(Pose2, WrapsToHalfOpenInterval) {
  EXPECT_NEAR(wrapAngle(-M_PI), M_PI, 1e-12);
  EXPECT_NEAR(wrapAngle(3 * M_PI), M_PI, 1e-9);
  EXPECT_NEAR(wrapAngle(2 * M_PI + 0.25), 0.25, 1e-12);
}

TEST(Pose2, SaysWhenItIsNotFinite) {
  EXPECT_TRUE((Pose2{1, 2, 3}).isFinite());
  EXPECT_FALSE((Pose2{1, NAN, 3}).isFinite());
}

TEST(Pose2, YawUncertaintyGrowsWithTheLever) {
  Eigen::Matrix3d yaw_only = Eigen::Matrix3d::Zero();
  yaw_only(2, 2) = 0.01;  // 0.1 rad
  const Eigen::Matrix3d sum = composeCovariance({0, 0, 0}, yaw_only, {2, 0, 0}, Eigen::Matrix3d::Zero());
  EXPECT_NEAR(sum(1, 1), 0.04, 1e-12);  // 2 m * 0.1 rad = 0.2 m across
  EXPECT_NEAR(sum(0, 0), 0, 1e-12);
  EXPECT_NEAR(sum(1, 2), 0.02, 1e-12);
}

}  // namespace
}  // namespace cornerstone
