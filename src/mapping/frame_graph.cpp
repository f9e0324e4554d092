#include "cornerstone/mapping/frame_graph.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr std::size_t kLooksKept = 10;  // a box that goes is free after 10 looks

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

bool mayMatch(const Pose2& a, const Pose2& b, const FrameGraphParams& params) {
  return (a.translation() - b.translation()).norm() <= params.match_distance_m &&
         std::abs(wrapAngle(a.yaw_rad - b.yaw_rad)) <= params.match_turn_rad;
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
    if (mayMatch(frames_[i].map_from_base, map_from_base, params_)) nearby.push_back(i);
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
  std::vector<PlacedMatch> placed_by;
  for (const std::size_t i : framesNearby(prior.map_from_base)) {
    const Pose2 expected = frames_[i].map_from_base.inverse() * prior.map_from_base;
    const auto match = matchFrames(frames_[i], frame, {expected, calibration_}, params_.match);
    if (!match) continue;
    matches_.push_back({i, frames_.size(), *match});
    placed_by.push_back({frames_[i].map_from_base, *match});
  }
  const PoseEstimate placed =
      place({prior, calibration_, params_.place_weight, params_.loss_sigmas}, placed_by);
  frame.map_from_base = placed.map_from_base;
  if (!frames_.empty()) frame.step_as_fitted = frames_.back().map_from_base.inverse() * placed.map_from_base;
  frames_.push_back(std::move(frame));
  return placed;
}

void FrameGraph::addLook(const RangeScan& scan, const Pose2& odom_from_base) {
  if (frames_.empty()) return;
  KeyFrame& frame = frames_.back();
  frame.looks.push_back(
      {std::make_shared<const RangeScan>(scan), frame.odom_from_base.inverse() * odom_from_base});
  if (frame.looks.size() > kLooksKept + 1) frame.looks.erase(frame.looks.begin() + 1);
}

bool FrameGraph::solveDue() const {
  const auto anew = static_cast<std::size_t>(params_.solve_after_frames);
  // A solution costs in proportion to all frames, so it waits for a share of them: its cost a frame is even.
  constexpr std::size_t kShare = 30;
  return frames_.size() >= solved_frames_ + std::max(anew, frames_.size() / kShare);
}

GraphProblem FrameGraph::problem() const {
  GraphProblem problem;
  problem.odometry = odometry_;
  problem.weights = {params_.match_weight, params_.loss_sigmas, params_.step_loss_sigmas,
                     params_.fitted_step_sigma_m, params_.fitted_step_sigma_rad};
  problem.matches = matches_;
  problem.rates = rates_;
  problem.calibration = calibration_;
  if (!frames_.empty()) problem.calibration_sigma_per_m = frames_.front().calibration_sigma_per_m;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    problem.map_from_base.push_back(frames_[i].map_from_base);
    if (i > 0)
      problem.steps.push_back(
          {frames_[i - 1].odom_from_base.inverse() * frames_[i].odom_from_base, frames_[i].step_as_fitted});
  }
  return problem;
}

GraphProblem FrameGraph::beginSolution() {
  solved_frames_ = frames_.size();
  return problem();
}

void FrameGraph::adopt(const GraphSolution& solution) {
  const Pose2 correction = correctionOf(solution, frames_);
  for (std::size_t i = 0; i < frames_.size(); ++i)
    frames_[i].map_from_base =
        i < solution.map_from_base.size() ? solution.map_from_base[i] : correction * frames_[i].map_from_base;
  rates_ = solution.rates;
  calibration_ = solution.calibration;
  matches_.insert(matches_.end(), solution.loop.begin(), solution.loop.end());
}

Pose2 correctionOf(const GraphSolution& solution, const std::vector<KeyFrame>& frames) {
  const std::size_t last = solution.map_from_base.size() - 1;
  return solution.map_from_base[last] * frames[last].map_from_base.inverse();
}

}  // namespace cornerstone
