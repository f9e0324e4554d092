#include "cornerstone/mapping/graph_solver.h"

#include <ceres/ceres.h>

#include <array>
#include <cmath>

#include "cornerstone/base/sqrt_information.h"
#include "cornerstone/mapping/frame_graph_costs.h"
#include "cornerstone/mapping/point_to_line_cost.h"

namespace cornerstone {
namespace {

using PoseBlock = std::array<double, 3>;

PoseBlock blockOf(const Pose2& pose) { return {pose.x_m, pose.y_m, pose.yaw_rad}; }
Pose2 poseOf(const PoseBlock& block) { return {block[0], block[1], wrapAngle(block[2])}; }

// Of what odometry does at random over a step; the systematic part is in the rates.
Eigen::Vector3d stepSigmas(const Pose2& step, const OdometryNoise& noise) {
  constexpr double kStill_m = 1e-3, kStill_rad = 3e-4;  // a robot that stands still jitters
  const double way_m = step.translation().norm();
  const double place_m = std::hypot(noise.noise_m_per_sqrt_m * std::sqrt(way_m), kStill_m);
  const double yaw_rad2 = std::pow(noise.noise_rad_per_sqrt_m, 2) * way_m +
                          std::pow(noise.noise_rad_per_sqrt_rad, 2) * std::abs(step.yaw_rad) +
                          kStill_rad * kStill_rad;
  return {place_m, place_m, std::sqrt(yaw_rad2)};
}

struct Blocks {
  double* earlier;
  double* later;
  double* shared;  // rates or calibration
};

void addStep(ceres::Problem& problem, const OdometryStepCost& cost, double loss_sigmas,
             const Blocks& blocks) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<OdometryStepCost, 3, 3, 3, 3>(new OdometryStepCost(cost)),
      new ceres::CauchyLoss(loss_sigmas), blocks.earlier, blocks.later, blocks.shared);
}

struct MatchWeight {
  double weight, loss_sigmas;
};

void addMatch(ceres::Problem& problem, const FrameMatch& match, const MatchWeight& weight,
              const Blocks& blocks) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<FrameMatchCost, 5, 3, 3, 2>(new FrameMatchCost(match)),
      new ceres::ScaledLoss(new ceres::CauchyLoss(weight.loss_sigmas), weight.weight, ceres::TAKE_OWNERSHIP),
      blocks.earlier, blocks.later, blocks.shared);
}

struct Unknowns {
  std::vector<PoseBlock> poses;
  PoseBlock rates;
  std::array<double, 2> calibration;
  PoseBlock no_rates{0, 0, 0};
};

Unknowns startOf(const GraphProblem& from) {
  Unknowns all;
  for (const Pose2& pose : from.map_from_base) all.poses.push_back(blockOf(pose));
  all.rates = {from.rates(0), from.rates(1), from.rates(2)};
  all.calibration = {from.calibration.offset_per_m, from.calibration.slope_per_m};
  return all;
}

void addSteps(const GraphProblem& from, Unknowns& all, ceres::Problem& problem) {
  const GraphWeights& weights = from.weights;
  const Eigen::Vector3d rate_sigmas(from.odometry.scale_ratio, from.odometry.yaw_drift_rad_per_m,
                                    from.odometry.turn_scale_ratio);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<ZeroPriorCost<3>, 3, 3>(new ZeroPriorCost<3>(rate_sigmas)), nullptr,
      all.rates.data());
  const double fitted_m = weights.fitted_step_sigma_m;
  const Eigen::Vector3d fitted_sigmas(fitted_m, fitted_m, weights.fitted_step_sigma_rad);
  for (std::size_t i = 0; i < from.steps.size(); ++i) {
    double *earlier = all.poses[i].data(), *later = all.poses[i + 1].data();
    const GraphStep& step = from.steps[i];
    addStep(problem, {step.by_odometry, stepSigmas(step.by_odometry, from.odometry)},
            weights.step_loss_sigmas, {earlier, later, all.rates.data()});
    addStep(problem, {step.as_fitted, fitted_sigmas}, weights.step_loss_sigmas,
            {earlier, later, all.no_rates.data()});
  }
  if (!from.steps.empty()) problem.SetParameterBlockConstant(all.no_rates.data());
}

void addCalibration(double sigma_per_m, Unknowns& all, ceres::Problem& problem) {
  problem.AddParameterBlock(all.calibration.data(), 2);
  if (sigma_per_m > 0)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ZeroPriorCost<2>, 2, 2>(
                                 new ZeroPriorCost<2>(Eigen::Vector2d::Constant(sigma_per_m))),
                             nullptr, all.calibration.data());
  else
    problem.SetParameterBlockConstant(all.calibration.data());
}

void addMatches(const GraphProblem& from, Unknowns& all, ceres::Problem& problem) {
  constexpr double kInFull = 1e6;  // sigmas: as good as no loss
  const std::size_t lossy = from.matches.size() - from.held_matches;
  for (std::size_t i = 0; i < from.matches.size(); ++i) {
    const GraphMatch& match = from.matches[i];
    addMatch(problem, match.match,
             {from.weights.match_weight, i < lossy ? from.weights.loss_sigmas : kInFull},
             {all.poses[match.earlier].data(), all.poses[match.later].data(), all.calibration.data()});
  }
}

void addAll(const GraphProblem& from, Unknowns& all, ceres::Problem& problem) {
  addSteps(from, all, problem);
  addMatches(from, all, problem);
  addCalibration(from.calibration_sigma_per_m, all, problem);
  problem.AddParameterBlock(all.poses.front().data(), 3);
  problem.SetParameterBlockConstant(all.poses.front().data());
}

}  // namespace

double costOf(const GraphProblem& from) {
  if (from.map_from_base.empty()) return 0;
  Unknowns all = startOf(from);
  ceres::Problem problem;
  addAll(from, all, problem);
  double cost = 0;
  problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

std::optional<GraphSolution> solve(const GraphProblem& from) {
  if (from.map_from_base.empty()) return std::nullopt;
  Unknowns all = startOf(from);
  ceres::Problem problem;
  addAll(from, all, problem);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // From the last solution it takes three to five; a loop that closes bends the whole way.
  options.max_num_iterations = from.held_matches > 0 ? 50 : 10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  if (!summary.IsSolutionUsable()) return std::nullopt;
  GraphSolution solution;
  for (const PoseBlock& pose : all.poses) {
    solution.map_from_base.push_back(poseOf(pose));
    if (!solution.map_from_base.back().isFinite()) return std::nullopt;
  }
  solution.rates = {all.rates[0], all.rates[1], all.rates[2]};
  solution.calibration = {all.calibration[0], all.calibration[1]};
  return solution;
}

PoseEstimate place(const GraphPlacement& placement, const std::vector<PlacedMatch>& matches) {
  const PoseEstimate& prior = placement.prior;
  if (matches.empty()) return prior;
  PoseBlock pose = blockOf(prior.map_from_base);
  const Eigen::Vector3d expected(pose[0], pose[1], pose[2]);
  std::vector<PoseBlock> earlier;
  earlier.reserve(matches.size());  // Ceres keeps pointers to these
  std::array<double, 2> calibration = {placement.calibration.offset_per_m, placement.calibration.slope_per_m};
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PosePriorCost, 3, 3>(
                               new PosePriorCost(expected, sqrtInformation(prior.covariance))),
                           nullptr, pose.data());
  for (const PlacedMatch& placed : matches) {
    earlier.push_back(blockOf(placed.map_from_earlier));
    addMatch(problem, placed.match, {placement.match_weight, placement.loss_sigmas},
             {earlier.back().data(), pose.data(), calibration.data()});
    problem.SetParameterBlockConstant(earlier.back().data());
  }
  problem.SetParameterBlockConstant(calibration.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance covariance(covariance_options);
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> of_pose;
  const std::vector<const double*> blocks = {pose.data()};
  if (!summary.IsSolutionUsable() || !covariance.Compute(blocks, &problem) ||
      !covariance.GetCovarianceMatrix(blocks, of_pose.data()) || !poseOf(pose).isFinite())
    return prior;
  return {poseOf(pose), of_pose};
}

}  // namespace cornerstone
