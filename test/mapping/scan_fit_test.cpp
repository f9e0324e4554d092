#include "cornerstone/mapping/scan_fit.h"

#include <ceres/ceres.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "cornerstone/mapping/point_to_line_cost.h"

namespace cornerstone {
namespace {

// Exact beams over 90 degrees from a pose to the walls x = 3 (if `end`) and y = +-1.
RangeScan corridorScan(const Pose2& pose, bool end) {
  RangeScan scan;
  for (int i = -45; i <= 45; ++i) {
    Beam beam;
    beam.bearing_rad = i * M_PI / 180;
    beam.width_rad = M_PI / 180;
    const double heading = pose.yaw_rad + beam.bearing_rad;
    double range_m = 100;
    if (std::sin(heading) > 1e-6) range_m = std::min(range_m, (1 - pose.y_m) / std::sin(heading));
    if (std::sin(heading) < -1e-6) range_m = std::min(range_m, (-1 - pose.y_m) / std::sin(heading));
    if (end && std::cos(heading) > 0) range_m = std::min(range_m, (3 - pose.x_m) / std::cos(heading));
    if (range_m < 5) {
      beam.hit = true;
      beam.range_m = range_m;
      beam.sigma_m = 0.02;
      beam.near_m = beam.clear_m = range_m - 0.04;
      beam.far_m = range_m + 0.04;
    }
    scan.beams.push_back(beam);
  }
  return scan;
}

OccupancyGrid corridorMap(bool end) {
  OccupancyGrid grid({});
  for (int i = 0; i < 10; ++i) {
    const Pose2 pose{-1 + 0.2 * i, 0, 0};
    grid.insert(corridorScan(pose, end), pose);
  }
  return grid;
}

PoseEstimate wide(const Pose2& pose) { return {pose, Eigen::Vector3d(0.01, 0.01, 0.0025).asDiagonal()}; }

TEST(ScanFit, FindsThePoseInACornerOfTheWorld) {
  const OccupancyGrid grid = corridorMap(true);
  ScanFitParams params;
  params.look_sigma_m = params.look_sigma_rad = 0;
  const Pose2 truth{0.53, 0.07, 0.05};
  const ScanFit fit = fitScan(corridorScan(truth, true), grid, {wide({0.48, 0.02, 0.02}), 1}, params);
  ASSERT_EQ(fit.state, FitState::kFitted);
  EXPECT_NEAR(fit.pose.map_from_base.x_m, truth.x_m, 0.01);
  EXPECT_NEAR(fit.pose.map_from_base.y_m, truth.y_m, 0.01);
  EXPECT_NEAR(fit.pose.map_from_base.yaw_rad, truth.yaw_rad, 0.006);
  EXPECT_LT(std::sqrt(fit.pose.covariance(0, 0)), 0.02);
}

TEST(ScanFit, AlongABareCorridorOdometryDecides) {
  const OccupancyGrid grid = corridorMap(false);
  const ScanFit fit = fitScan(corridorScan({0.53, 0.07, 0}, false), grid, {wide({0.45, 0.02, 0}), 1}, {});
  ASSERT_EQ(fit.state, FitState::kFitted);
  EXPECT_NEAR(fit.pose.map_from_base.x_m, 0.45, 0.01);
  EXPECT_NEAR(std::sqrt(fit.pose.covariance(0, 0)), 0.1, 0.01);  // as before
  EXPECT_NEAR(fit.pose.map_from_base.y_m, 0.07, 0.015);
  EXPECT_LT(std::sqrt(fit.pose.covariance(1, 1)), 0.03);
}

TEST(ScanFit, LeavesOutBeamsBesideDepthEdges) {
  const OccupancyGrid grid = corridorMap(true);
  const Pose2 pose{0.5, 0, 0};
  RangeScan scan = corridorScan(pose, true);
  // A pillar of 11 beams half way to the end wall, which is seen over 44 degrees: the map does not know it.
  for (std::size_t i = 40; i <= 50; ++i) {
    for (double* length_m : {&scan.beams[i].range_m, &scan.beams[i].near_m, &scan.beams[i].far_m})
      *length_m /= 2;
    scan.beams[i].clear_m = scan.beams[i].near_m;
  }
  ScanFitParams all, straight;
  all.straight_beams = 0;
  straight.straight_beams = 3;
  const auto matches = [&](const RangeScan& of, const ScanFitParams& params) {
    return fitScan(of, grid, {wide(pose), 1}, params).matches;
  };
  const RangeScan bare = corridorScan(pose, true);
  EXPECT_EQ(matches(bare, all) - matches(scan, all), 11);
  EXPECT_EQ(matches(bare, straight) - matches(scan, straight), 11 + 2 * 3);  // and 3 of the wall to each side
}

TEST(ScanFit, SaysWhenThereIsNothingToFit) {
  const OccupancyGrid grid = corridorMap(true);
  const ScanFit fit = fitScan(corridorScan({0, 0, 0}, true), grid, {wide({50, 0, 0}), 1}, {});
  EXPECT_EQ(fit.state, FitState::kTooLittle);
  EXPECT_NEAR(fit.pose.map_from_base.x_m, 50, 1e-12);
  EXPECT_EQ(fitScan({}, grid, {wide({}), 1}, {}).state, FitState::kTooLittle);
  EXPECT_EQ(fitScan(corridorScan({}, true), OccupancyGrid({}), {wide({}), 1}, {}).state,
            FitState::kTooLittle);
}

TEST(ScanFit, ARepeatedLookSaysLess) {
  const OccupancyGrid grid = corridorMap(true);
  const auto scan = corridorScan({0.53, 0.07, 0}, true);
  const ScanFit whole = fitScan(scan, grid, {wide({0.5, 0.02, 0}), 1}, {});
  const ScanFit part = fitScan(scan, grid, {wide({0.5, 0.02, 0}), 0.01}, {});
  EXPECT_GT(part.pose.covariance(1, 1), 4 * whole.pose.covariance(1, 1));
}

void expectGradient(const ceres::CostFunction& cost, double* pose) {
  std::vector<double> residuals(static_cast<std::size_t>(cost.num_residuals()), NAN);
  double* parameters[] = {pose};
  ASSERT_TRUE(cost.Evaluate(parameters, residuals.data(), nullptr));
  for (const double residual : residuals) EXPECT_TRUE(std::isfinite(residual));
  const std::vector<const ceres::Manifold*>* none = nullptr;
  ceres::GradientChecker checker(&cost, none, ceres::NumericDiffOptions{});
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(parameters, 1e-6, &results)) << results.error_log;
}

TEST(PointToLineCost, HandNumberAndGradient) {
  // The end (2, 0) of a base at (1, 1) turned by 90 degrees is (1, 3); the line y = 2.5 is 0.5 m = 5 sigma
  // below.
  const ceres::AutoDiffCostFunction<PointToLineCost, 1, 3> cost(
      new PointToLineCost({{2, 0}, {7, 2.5}, {0, 1}, 0.1}));
  double pose[] = {1, 1, M_PI / 2};
  const double* parameters[] = {pose};
  double residual = NAN;
  ASSERT_TRUE(cost.Evaluate(parameters, &residual, nullptr));
  EXPECT_NEAR(residual, 5, 1e-9);
  double other[] = {1, 1, 0.7};
  expectGradient(cost, other);
}

TEST(PosePriorCost, HandNumberAndGradient) {
  const Eigen::Matrix3d weight = Eigen::Vector3d(10, 20, 30).asDiagonal();
  const ceres::AutoDiffCostFunction<PosePriorCost, 3, 3> cost(new PosePriorCost({1, 2, 0.1}, weight));
  double pose[] = {1.1, 2, 0.2};
  const double* parameters[] = {pose};
  double residuals[] = {NAN, NAN, NAN};
  ASSERT_TRUE(cost.Evaluate(parameters, residuals, nullptr));
  EXPECT_NEAR(residuals[0], 1, 1e-9);
  EXPECT_NEAR(residuals[1], 0, 1e-9);
  EXPECT_NEAR(residuals[2], 3, 1e-9);
  expectGradient(cost, pose);
}

}  // namespace
}  // namespace cornerstone
