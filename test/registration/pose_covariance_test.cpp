#include "cornerstone/registration/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "cornerstone/registration/register_maps.h"
#include "support/drawn_maps.h"

namespace cornerstone {
namespace {

// A square room of 4 m, a pair each 0.1 m of its walls, all of them off by the same residual along the
// normal.
std::vector<LinePair> room(double turn_rad, double residual_m) {
  std::vector<LinePair> pairs;
  for (int side = 0; side < 4; ++side) {
    const Pose2 wall{0, 0, turn_rad + side * M_PI / 2};
    for (int i = -19; i < 20; ++i) {
      const Eigen::Vector2d at = wall * Eigen::Vector2d(0.1 * i, 2);
      const Eigen::Vector2d normal = wall.rotation() * Eigen::Vector2d(0, -1);
      pairs.push_back({at, at + residual_m * normal, normal, 1});
    }
  }
  return pairs;
}

TEST(PoseCovariance, WallsAlongTheGridAreRightToAPartOfACellHoweverLong) {
  const std::vector<LinePair> pairs = room(0, 0);
  const FitQuality quality = judgeFit({pairs, {0, 0, 0}, 0.01, 0.05});
  // x is the mean of two walls, each off by a uniform part of a cell in either map: 2 (0.05^2 / 12) / 2.
  EXPECT_NEAR(quality.covariance(0, 0), 0.05 * 0.05 / 12, 1e-8);
  EXPECT_NEAR(quality.covariance(1, 1), 0.05 * 0.05 / 12, 1e-8);
  EXPECT_NEAR(quality.spread, 1, 1e-6);
}

TEST(PoseCovariance, WallsAcrossTheGridAreAveraged) {
  const std::vector<LinePair> pairs = room(0.4, 0);
  const FitQuality quality = judgeFit({pairs, {0, 0, 0}, 0.01, 0.05});
  // Over 3.8 m the wall passes 3.8 tan 0.4 / 0.05 = 32 cells, and what is left of one of them counts.
  EXPECT_LT(quality.covariance(0, 0), 0.05 * 0.05 / 12 / 900);
  EXPECT_GT(quality.covariance(0, 0), 0);
}

TEST(PoseCovariance, ScatterOfTheResidualsAddsToIt) {
  const std::vector<LinePair> calm = room(0.4, 0.001), wild = room(0.4, 0.02);
  const Eigen::Vector3d at(0, 0, 0);
  EXPECT_GT(judgeFit({wild, at, 0.02, 0.05}).covariance(0, 0),
            10 * judgeFit({calm, at, 0.001, 0.05}).covariance(0, 0));
  EXPECT_NEAR(judgeFit({wild, at, 0.02, 0.05}).rms_m, 0.02, 1e-9);
}

// The error of a pose, squared by its covariance, is a chi-square of three degrees of freedom: 3 in the mean,
// and above 7.81 in 5 of 100. The mean of 60 is within 1 of it.
TEST(PoseCovariance, IsTrueOverManyRegistrations) {
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double sum = 0;
  int beyond = 0;
  constexpr int kPairs = 60;
  for (unsigned i = 0; i < kPairs; ++i) {
    const Pose2 there{uniform(-1, 1), uniform(-1, 1), uniform(-3, 3)};
    const Pose2 here{uniform(-1, 1), uniform(-1, 1), uniform(-3, 3)};
    const double noise = uniform(0, 0.2);
    const GridMap a = draw(drawnOffice(), {there, {-1, -2, uniform(9, 18), 12}, noise, 2 * i + 1});
    const GridMap b = draw(drawnOffice(), {here, {uniform(-1, 5), -2, 18, 12}, noise, 2 * i + 2});
    const Landmarks in_a = detectLandmarks(a, {}), in_b = detectLandmarks(b, {});
    const Pose2 truth = there.inverse() * here;
    RegistrationHints hints;
    hints.prior = truth * Pose2{0.2, -0.1, 0.05};
    const auto [answer, refusal] = registerMaps(MapView{a, in_a}, MapView{b, in_b}, hints, {});
    ASSERT_TRUE(answer) << refusal;
    const Pose2& pose = answer->reference_from_current;
    const Eigen::Vector3d error(pose.x_m - truth.x_m, pose.y_m - truth.y_m,
                                wrapAngle(pose.yaw_rad - truth.yaw_rad));
    const double squared = error.dot(answer->covariance.ldlt().solve(error));
    sum += squared;
    beyond += squared > 7.81;
  }
  EXPECT_GT(sum / kPairs, 2);
  EXPECT_LT(sum / kPairs, 4);
  EXPECT_LE(beyond, 9);
}

}  // namespace
}  // namespace cornerstone
