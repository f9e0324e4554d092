#include "cornerstone/mapping/frame_graph.h"

#include <ceres/ceres.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/frame_graph_costs.h"
#include "support/room_scan.h"
#include "support/tour.h"

namespace cornerstone {
namespace {

// The largest relative difference between given and numeric derivatives; residuals start as NaN.
template <typename Cost>
void expectTrueGradient(Cost&& cost, std::vector<std::vector<double>> blocks) {
  std::vector<double*> parameters;
  for (auto& block : blocks) parameters.push_back(block.data());
  std::vector<double> residuals(static_cast<std::size_t>(cost.num_residuals()), NAN);
  ASSERT_TRUE(cost.Evaluate(parameters.data(), residuals.data(), nullptr));
  for (const double residual : residuals) EXPECT_TRUE(std::isfinite(residual));
  ceres::GradientChecker checker(&cost, static_cast<const std::vector<const ceres::Manifold*>*>(nullptr),
                                 ceres::NumericDiffOptions());
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(parameters.data(), 1e-6, &results)) << results.error_log;
}

TEST(FrameGraphCosts, MatchHasTrueDerivatives) {
  FrameMatch match;
  match.earlier_from_later = {0.5, -0.2, 3.0};
  match.sqrt_information.setRandom();
  match.offset.setRandom();
  expectTrueGradient(ceres::AutoDiffCostFunction<FrameMatchCost, 5, 3, 3, 2>(new FrameMatchCost(match)),
                     {{1, 2, 0.4}, {1.4, 2.1, -3.1}, {0.01, -0.02}});
}

TEST(FrameGraphCosts, OdometryStepHasTrueDerivativesAndIsZeroAtItsOwnStep) {
  const Pose2 step{0.25, 0.01, 0.1};
  ceres::AutoDiffCostFunction<OdometryStepCost, 3, 3, 3, 3> cost(
      new OdometryStepCost(step, {0.01, 0.02, 0.003}));
  expectTrueGradient(cost, {{1, 2, 0.4}, {1.2, 2.1, 0.55}, {0.02, 0.01, -0.03}});
  const double drift = 0.01 * 0.25 - 0.03 * 0.1;
  const Eigen::Vector2d way = 0.98 * (Pose2{0, 0, -0.5 * drift}.rotation() * step.translation());
  const Pose2 from{1, 2, 0.4}, to = from * Pose2{way.x(), way.y(), 0.1 - drift};
  const double earlier[] = {from.x_m, from.y_m, from.yaw_rad}, later[] = {to.x_m, to.y_m, to.yaw_rad};
  const double rates[] = {0.02, 0.01, -0.03};
  const double* blocks[] = {earlier, later, rates};
  double residuals[3] = {NAN, NAN, NAN};
  ASSERT_TRUE(cost.Evaluate(blocks, residuals, nullptr));
  for (const double residual : residuals) EXPECT_NEAR(residual, 0, 1e-9);
}

// The robot drives straight; at each of a hundred parts odometry believes to have turned a little.
TEST(FrameGraphCosts, HeadingThatIsLostAlongAStepTurnsIt) {
  Pose2 step;
  for (int i = 0; i < 100; ++i) step = step * Pose2{0.004, 0, 0.0004};
  const OdometryStepCost cost(step, {0.01, 0.01, 0.01});
  const double earlier[] = {0, 0, 0}, later[] = {0.4, 0, 0}, rates[] = {0, 0.1, 0};
  double residuals[3] = {NAN, NAN, NAN};
  ASSERT_TRUE(cost(earlier, later, rates, residuals));
  EXPECT_NEAR(residuals[1], 0, 0.01);  // 0.8 if the step were taken as straight
  for (const double residual : residuals) EXPECT_LT(std::abs(residual), 0.02);
}

TEST(FrameGraphCosts, PriorHasTrueDerivatives) {
  expectTrueGradient(
      ceres::AutoDiffCostFunction<ZeroPriorCost<2>, 2, 2>(new ZeroPriorCost<2>(Eigen::Vector2d(0.1, 0.2))),
      {{0.3, -0.1}});
}

// A pose along x, known to 2 cm and a degree.
PoseEstimate at(double x_m) { return {{x_m, 0, 0}, Eigen::Vector3d(4e-4, 4e-4, 3e-4).asDiagonal()}; }

struct Driven {
  FrameGraph graph;
  Pose2 last_by_odometry, last_true;
};

// officeTour() with drifting odometry and a rig that is off; poses enter as odometry has them.
Driven drive(const FrameGraphParams& params, const test::TourParams& tour, const ScanCalibration& needed) {
  std::mt19937 random(3);
  const auto steps = test::driveTour(test::officeTour(), tour, random);
  const test::Room room = test::officeRoom();
  const Pose2 start = steps.front().map_from_base;
  Driven driven{FrameGraph(params, OdometryNoise{}), {}, {}};
  for (const auto& step : steps) {
    if (!driven.graph.frameDue(step.odom_from_base)) continue;
    const Pose2 corrected_pose =
        driven.graph.frames().empty()
            ? step.odom_from_base
            : driven.graph.frames().back().map_from_base *
                  (driven.graph.frames().back().odom_from_base.inverse() * step.odom_from_base);
    driven.graph.addFrame(test::scanOf(room, step.map_from_base, needed), step.odom_from_base,
                          {corrected_pose, at(0).covariance});
    if (driven.graph.solveDue()) driven.graph.adopt(solve(driven.graph.beginSolution()).value());
    driven.last_by_odometry = step.odom_from_base;
    driven.last_true = start.inverse() * step.map_from_base;
  }
  driven.graph.adopt(solve(driven.graph.beginSolution()).value());
  return driven;
}

// 48 m, 1 % of scale and half a degree a metre: metres off by odometry, centimetres by the graph.
TEST(FrameGraph, BendsADriftingWayStraightAndLearnsTheCalibration) {
  test::TourParams tour;
  tour.scale_error = 0.01;
  tour.yaw_drift_rad_per_m = 0.009;
  tour.noise_m_per_sqrt_m = 0.005;
  tour.noise_rad_per_sqrt_m = 0.004;
  const ScanCalibration needed{0.006, -0.004};
  const Driven driven = drive({}, tour, needed);
  const Pose2 odometry_error = driven.last_true.inverse() * driven.last_by_odometry;
  const Pose2 error = driven.last_true.inverse() * driven.graph.frames().back().map_from_base;
  EXPECT_GT(odometry_error.translation().norm(), 0.5);
  EXPECT_LT(error.translation().norm(), 0.05);
  EXPECT_LT(std::abs(error.yaw_rad), 0.017);  // a degree
  EXPECT_NEAR(driven.graph.calibration().offset_per_m, needed.offset_per_m, 0.002);
  EXPECT_NEAR(driven.graph.calibration().slope_per_m, needed.slope_per_m, 0.002);
}

TEST(FrameGraph, ANewFrameIsPlacedByTheFramesThatStand) {
  FrameGraph graph({}, OdometryNoise{});
  const test::Room room = test::officeRoom();
  const auto add = [&](const Pose2& truth, const Pose2& claimed) {
    return graph.addFrame(test::scanOf(room, truth), claimed, {claimed, 9 * at(0).covariance});
  };
  const PoseEstimate first = add({2, 2, 0.7}, {2, 2, 0.7});
  EXPECT_NEAR(first.map_from_base.x_m, 2, 1e-9);  // nothing to hold it against
  for (int i = 1; i < 6; ++i) add({2 + 0.1 * i, 2, 0.7}, {2 + 0.1 * i, 2, 0.7});
  const PoseEstimate placed = add({2.6, 2, 0.75}, {2.63, 1.98, 0.77});
  EXPECT_NEAR(placed.map_from_base.x_m, 2.6, 0.012);
  EXPECT_NEAR(placed.map_from_base.y_m, 2.0, 0.012);
  EXPECT_NEAR(placed.map_from_base.yaw_rad, 0.75, 0.008);
  EXPECT_LT(placed.covariance(2, 2), at(0).covariance(2, 2) / 2);
}

TEST(FrameGraph, SensorsWithoutACommonErrorGetNoCalibration) {
  FrameGraph graph({}, OdometryNoise{});
  const test::Room room = test::officeRoom();
  for (int i = 0; i < 8; ++i) {
    const Pose2 pose{2 + 0.1 * i, 2, 0.7 + 0.1 * i};
    RangeScan scan = test::scanOf(room, pose, {0.01, 0});
    scan.calibration_sigma_per_m = 0;
    graph.addFrame(scan, pose, {pose, at(0).covariance});
  }
  EXPECT_GT(graph.matches().size(), 6U);
  EXPECT_EQ(solve(graph.beginSolution()).value().calibration.offset_per_m, 0);
}

TEST(FrameGraph, KeepsTheNewestLooksOfARobotThatStaysAndOneOfARobotThatGoesOn) {
  FrameGraph graph({}, OdometryNoise{});
  const RangeScan scan = test::scanOf(test::officeRoom(), {2, 2, 0.7});
  graph.addFrame(scan, {}, at(0));
  for (int i = 0; i < 30; ++i) graph.addLook(scan, {0.001 * i, 0, 0});
  ASSERT_EQ(graph.frames()[0].looks.size(), 11U);
  EXPECT_NEAR(graph.frames()[0].looks.back().frame_from_base.x_m, 0.029, 1e-9);
  graph.addFrame(scan, {0.3, 0, 0}, at(0.3));
  graph.addLook(scan, {0.4, 0, 0});
  graph.addFrame(scan, {0.6, 0, 0}, at(0.6));
  EXPECT_EQ(graph.frames()[0].looks.size(), 11U);
  EXPECT_EQ(graph.frames()[1].looks.size(), 1U);
}

TEST(FrameGraph, WithoutFramesThereIsNoSolution) {
  EXPECT_FALSE(solve(FrameGraph({}, OdometryNoise{}).beginSolution()));
}

TEST(FrameGraph, RefusesParametersOutOfRange) {
  FrameGraphParams params;
  params.match_weight = 0;
  EXPECT_THROW(FrameGraph(params, OdometryNoise{}), InputError);
}

}  // namespace
}  // namespace cornerstone
