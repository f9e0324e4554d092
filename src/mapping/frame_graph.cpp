#include "cornerstone/mapping/frame_graph.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"
#include "cornerstone/base/sqrt_information.h"
#include "cornerstone/mapping/frame_graph_costs.h"
#include "cornerstone/mapping/point_to_line_cost.h"

namespace cornerstone {
namespace {

constexpr std::size_t kLooksKept = 10;  // a box that goes is free after 10 looks

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

bool alike(const Pose2& a, const Pose2& b, const FrameGraphParams& params) {
  return (a.translation() - b.translation()).norm() <= params.match_distance_m &&
         std::abs(wrapAngle(a.yaw_rad - b.yaw_rad)) <= params.match_turn_rad;
}

}  // namespace

void describe(ParamVisitor& visitor, FrameGraphParams& params) {
  visitor.field("use", params.use);
  visitor.field("frame_distance_m", params.frame_distance_m);
  visitor.degrees("frame_turn_deg", params.frame_turn_rad);
  visitor.field("match_distance_m", params.match_distance_m);
  visitor.degrees("match_turn_deg", params.match_turn_rad);
  visitor.field("match_tries", params.match_tries);
  visitor.field("match_weight", params.match_weight);
  visitor.field("place_weight", params.place_weight);
  visitor.field("loss_sigmas", params.loss_sigmas);
  visitor.field("step_loss_sigmas", params.step_loss_sigmas);
  visitor.field("fitted_step_sigma_m", params.fitted_step_sigma_m);
  visitor.degrees("fitted_step_sigma_deg", params.fitted_step_sigma_rad);
  visitor.field("solve_after_frames", params.solve_after_frames);
  visitor.field("redraw_looks_per_scan", params.redraw_looks_per_scan);
  visitor.field("redraw_shift_m", params.redraw_shift_m);
  visitor.group("piece", [&] { describe(visitor, params.piece); });
  visitor.group("match", [&] { describe(visitor, params.match); });
}

void requireValid(const FrameGraphParams& params) {
  requireWithin(params.frame_distance_m, 0.01, 10, "frame_distance_m");
  requireWithin(params.frame_turn_rad, 0.01, 3, "frame_turn_deg");
  requireWithin(params.match_distance_m, 0.1, 100, "match_distance_m");
  requireWithin(params.match_turn_rad, 0.01, 3.2, "match_turn_deg");
  requireWithin(params.match_tries, 1, 10000, "match_tries");
  requireWithin(params.match_weight, 1e-3, 1, "match_weight");
  requireWithin(params.place_weight, 1e-3, 1, "place_weight");
  requireWithin(params.loss_sigmas, 0.1, 100, "loss_sigmas");
  requireWithin(params.step_loss_sigmas, 0.1, 1000, "step_loss_sigmas");
  requireWithin(params.fitted_step_sigma_m, 1e-4, 100, "fitted_step_sigma_m");
  requireWithin(params.fitted_step_sigma_rad, 1e-4, 100, "fitted_step_sigma_deg");
  requireWithin(params.solve_after_frames, 1, 100000, "solve_after_frames");
  requireWithin(params.redraw_looks_per_scan, 2, 10000, "redraw_looks_per_scan");
  requireWithin(params.redraw_shift_m, 0, 10, "redraw_shift_m");
  requireValid(params.piece);
  requireValid(params.match);
}

FrameGraph::FrameGraph(const FrameGraphParams& params, const OdometryNoise& odometry)
    : params_(params), odometry_(odometry) {
  requireValid(params);
  requireValid(odometry);
}

bool FrameGraph::frameDue(const Pose2& odom_from_base) const {
  if (frames_.empty()) return true;
  const Pose2 moved = frames_.back().odom_from_base.inverse() * odom_from_base;
  return moved.translation().norm() > params_.frame_distance_m ||
         std::abs(moved.yaw_rad) > params_.frame_turn_rad;
}

std::vector<std::size_t> FrameGraph::framesNearby(const Pose2& map_from_base) const {
  std::vector<std::size_t> nearby;
  for (std::size_t i = 0; i < frames_.size(); ++i)
    if (alike(frames_[i].map_from_base, map_from_base, params_)) nearby.push_back(i);
  const auto most = static_cast<std::size_t>(params_.match_tries);
  if (nearby.size() <= most) return nearby;
  std::vector<std::size_t> spread;  // over all, the newest among them
  for (std::size_t i = 0; i < most; ++i) spread.push_back(nearby[(i + 1) * nearby.size() / most - 1]);
  return spread;
}

PoseEstimate FrameGraph::addFrame(const RangeScan& scan, const Pose2& odom_from_base,
                                  const PoseEstimate& prior) {
  // Where the robot has gone on, the frame's own look is enough; where it stayed, the newest are.
  if (!frames_.empty() && frames_.back().looks.size() <= kLooksKept) frames_.back().looks.resize(1);
  KeyFrame frame = makeKeyFrame(scan, odom_from_base, prior.map_from_base, params_.piece);
  const std::size_t first_match = matches_.size();
  for (const std::size_t i : framesNearby(prior.map_from_base)) {
    const Pose2 expected = frames_[i].map_from_base.inverse() * prior.map_from_base;
    const auto match = matchFrames(frames_[i], frame, {expected, calibration_}, params_.match);
    if (match) matches_.push_back({i, frames_.size(), *match});
  }
  const PoseEstimate placed = placeNewest(prior, first_match);
  frame.map_from_base = placed.map_from_base;
  if (!frames_.empty()) frame.step_as_fitted = frames_.back().map_from_base.inverse() * placed.map_from_base;
  frames_.push_back(std::move(frame));
  return placed;
}

PoseEstimate FrameGraph::placeNewest(const PoseEstimate& prior, std::size_t first_match) const {
  if (first_match == matches_.size()) return prior;
  PoseBlock pose = blockOf(prior.map_from_base);
  const Eigen::Vector3d expected(pose[0], pose[1], pose[2]);
  std::vector<PoseBlock> earlier;
  earlier.reserve(matches_.size() - first_match);  // Ceres keeps pointers to these
  std::array<double, 2> calibration = {calibration_.offset_per_m, calibration_.slope_per_m};
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PosePriorCost, 3, 3>(
                               new PosePriorCost(expected, sqrtInformation(prior.covariance))),
                           nullptr, pose.data());
  for (std::size_t i = first_match; i < matches_.size(); ++i) {
    earlier.push_back(blockOf(frames_[matches_[i].earlier].map_from_base));
    addMatch(problem, matches_[i].match, params_.place_weight,
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

void FrameGraph::addStep(ceres::Problem& problem, const OdometryStepCost& cost, const Blocks& blocks) const {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<OdometryStepCost, 3, 3, 3, 3>(new OdometryStepCost(cost)),
      new ceres::CauchyLoss(params_.step_loss_sigmas), blocks.earlier, blocks.later, blocks.shared);
}

void FrameGraph::addMatch(ceres::Problem& problem, const FrameMatch& match, double weight,
                          const Blocks& blocks) const {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<FrameMatchCost, 5, 3, 3, 2>(new FrameMatchCost(match)),
      new ceres::ScaledLoss(new ceres::CauchyLoss(params_.loss_sigmas), weight, ceres::TAKE_OWNERSHIP),
      blocks.earlier, blocks.later, blocks.shared);
}

void FrameGraph::addLook(const RangeScan& scan, const Pose2& odom_from_base) {
  if (frames_.empty()) return;
  KeyFrame& frame = frames_.back();
  frame.looks.push_back({scan, frame.odom_from_base.inverse() * odom_from_base});
  if (frame.looks.size() > kLooksKept + 1) frame.looks.erase(frame.looks.begin() + 1);
}

bool FrameGraph::solveDue() const {
  const auto anew = static_cast<std::size_t>(params_.solve_after_frames);
  // A solution costs in proportion to all frames, so it waits for a share of them: its cost a frame is even.
  constexpr std::size_t kShare = 30;
  return frames_.size() >= solved_frames_ + std::max(anew, frames_.size() / kShare);
}

std::optional<GraphSolution> FrameGraph::solve() {
  if (frames_.empty()) return std::nullopt;
  solved_frames_ = frames_.size();
  std::vector<PoseBlock> poses;
  for (const KeyFrame& frame : frames_) poses.push_back(blockOf(frame.map_from_base));
  PoseBlock rates = {rates_(0), rates_(1), rates_(2)};
  std::array<double, 2> calibration = {calibration_.offset_per_m, calibration_.slope_per_m};
  const Eigen::Vector3d rate_sigmas(odometry_.scale_ratio, odometry_.yaw_drift_rad_per_m,
                                    odometry_.turn_scale_ratio);
  const double calibration_sigma = frames_.front().calibration_sigma_per_m;

  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<ZeroPriorCost<3>, 3, 3>(new ZeroPriorCost<3>(rate_sigmas)), nullptr,
      rates.data());
  PoseBlock no_rates = {0, 0, 0};
  const double fitted_m = params_.fitted_step_sigma_m;
  const Eigen::Vector3d fitted_sigmas(fitted_m, fitted_m, params_.fitted_step_sigma_rad);
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    const Pose2 step = frames_[i - 1].odom_from_base.inverse() * frames_[i].odom_from_base;
    addStep(problem, {step, stepSigmas(step, odometry_)},
            {poses[i - 1].data(), poses[i].data(), rates.data()});
    addStep(problem, {frames_[i].step_as_fitted, fitted_sigmas},
            {poses[i - 1].data(), poses[i].data(), no_rates.data()});
  }
  if (problem.HasParameterBlock(no_rates.data())) problem.SetParameterBlockConstant(no_rates.data());
  for (const Match& match : matches_)
    addMatch(problem, match.match, params_.match_weight,
             {poses[match.earlier].data(), poses[match.later].data(), calibration.data()});
  problem.AddParameterBlock(calibration.data(), 2);
  if (calibration_sigma > 0)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ZeroPriorCost<2>, 2, 2>(
                                 new ZeroPriorCost<2>(Eigen::Vector2d::Constant(calibration_sigma))),
                             nullptr, calibration.data());
  else
    problem.SetParameterBlockConstant(calibration.data());
  problem.AddParameterBlock(poses.front().data(), 3);
  problem.SetParameterBlockConstant(poses.front().data());

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 10;  // from the last solution it takes three to five
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  if (!summary.IsSolutionUsable()) return std::nullopt;
  GraphSolution solution;
  for (const PoseBlock& pose : poses) {
    solution.map_from_base.push_back(poseOf(pose));
    if (!solution.map_from_base.back().isFinite()) return std::nullopt;
  }
  solution.rates = {rates[0], rates[1], rates[2]};
  solution.calibration = {calibration[0], calibration[1]};
  return solution;
}

void FrameGraph::adopt(const GraphSolution& solution) {
  const Pose2 correction = correctionOf(solution, frames_);
  for (std::size_t i = 0; i < frames_.size(); ++i)
    frames_[i].map_from_base =
        i < solution.map_from_base.size() ? solution.map_from_base[i] : correction * frames_[i].map_from_base;
  rates_ = solution.rates;
  calibration_ = solution.calibration;
}

Pose2 correctionOf(const GraphSolution& solution, const std::vector<KeyFrame>& frames) {
  const std::size_t last = solution.map_from_base.size() - 1;
  return solution.map_from_base[last] * frames[last].map_from_base.inverse();
}

}  // namespace cornerstone
