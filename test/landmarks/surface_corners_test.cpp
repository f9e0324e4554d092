#include "cornerstone/landmarks/surface_corners.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

constexpr double kArm_m = 0.5;
const Pose2 kTruth{3, -2, 0.7};

// Surface along the arms of a corner, a point each 5 cm, shifted across the arms to the outside.
std::vector<SurfacePoint> surfaceAlong(const Pose2& corner, double length_m, double shift_m = 0,
                                       float weight = 1e4f) {
  std::vector<SurfacePoint> surface;
  for (double along = 0.02; along < length_m; along += 0.05)
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(along, -shift_m), Eigen::Vector2d(-shift_m, along)}) {
      const Eigen::Vector2f at = (corner * p).cast<float>();
      surface.push_back({at.x(), at.y(), weight});
    }
  return surface;
}

CornerLandmark drawnAt(const Pose2& pose) {
  CornerLandmark corner;
  corner.pose = pose;
  corner.covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-3).asDiagonal();
  return corner;
}

TEST(SurfaceCorners, ARoundedCornerIsSettledToAMillimetre) {
  const SurfaceCorners corners(surfaceAlong(kTruth, 1), kArm_m);
  for (const Pose2& off : {Pose2{}, Pose2{0.03, 0.02, 0}, Pose2{-0.03, 0.03, 0.07}, Pose2{0, -0.04, -0.07}}) {
    const CornerLandmark settled = corners.settled(drawnAt(kTruth * off));
    EXPECT_LT((settled.pose.translation() - kTruth.translation()).norm(), 0.001);
    EXPECT_NEAR(settled.pose.yaw_rad, kTruth.yaw_rad, 0.002);
    EXPECT_LT(std::sqrt(settled.covariance(0, 0)), 0.01);
    EXPECT_GT(std::sqrt(settled.covariance(0, 0)), 0.001) << "no surface is known better than this";
  }
}

TEST(SurfaceCorners, TheOtherFaceOfAThinWallDoesNotCount) {
  std::vector<SurfacePoint> both = surfaceAlong(kTruth, 1);
  const std::vector<SurfacePoint> other = surfaceAlong(kTruth, 1, 0.1);
  both.insert(both.end(), other.begin(), other.end());
  const CornerLandmark settled = SurfaceCorners(both, kArm_m).settled(drawnAt(kTruth * Pose2{0.01, 0.01, 0}));
  EXPECT_LT((settled.pose.translation() - kTruth.translation()).norm(), 0.002);
}

void expectAsItWas(const std::vector<SurfacePoint>& surface) {
  const CornerLandmark drawn = drawnAt(kTruth);
  const CornerLandmark settled = SurfaceCorners(surface, kArm_m).settled(drawn);
  EXPECT_EQ(settled.pose.x_m, drawn.pose.x_m);
  EXPECT_EQ(settled.pose.yaw_rad, drawn.pose.yaw_rad);
  EXPECT_EQ(settled.covariance, drawn.covariance);
}

TEST(SurfaceCorners, StaysWhereTheSurfaceOfAnArmIsNotKnown) {
  expectAsItWas({});
  expectAsItWas(surfaceAlong(kTruth, 0.2));
  std::vector<SurfacePoint> one_arm;
  for (const SurfacePoint& point : surfaceAlong(kTruth, 1))
    if ((kTruth.inverse() * point.position_m()).y() < 0.01) one_arm.push_back(point);
  ASSERT_GT(one_arm.size(), 10u);
  expectAsItWas(one_arm);
}

TEST(SurfaceCorners, StaysWhereTheSurfaceIsAnother) {
  expectAsItWas(surfaceAlong(kTruth, 1, 0.2));
  expectAsItWas(surfaceAlong({30, -20, 0.7}, 1));
}

}  // namespace
}  // namespace cornerstone
