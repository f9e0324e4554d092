#include "cornerstone/landmarks/corner_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <bitset>
#include <cmath>

namespace cornerstone {
namespace {

constexpr double kFacesArmCosine = 0.80;   // 37 degrees: an edge that may belong to an arm
constexpr double kMayFaceArmCosine = 0.6;  // the same before the arms have settled
constexpr int kSettleRounds = 3;           // edges are chosen anew at each; the choice stays after two
constexpr double kConverged = 0.05;        // cells and degrees: a change "very small" to the paper
constexpr int kMaxBins = 64;

int pointsPerArm(const LandmarkParams& params) {
  return std::max(static_cast<int>(std::lround(params.arm_length_m / params.model_spacing_m)) + 1, 3);
}

// Of an arm's length, for its support.
int binsOf(const LandmarkParams& params) { return std::min(pointsPerArm(params) - 1, kMaxBins); }

// What the edges beside both arms say of a corner pose.
struct ArmEvidence {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // J'J, J = d(distance to the arm) / d(pose)
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     // J'e
  double squares_m2 = 0;
  int count = 0;
  std::array<double, 2> support{};  // share of each arm's length that edges cover
};

ArmEvidence gather(const std::vector<EdgePoint>& edges, const Pose2& pose, double facing,
                   const LandmarkParams& params) {
  ArmEvidence evidence;
  const int bins = binsOf(params);
  std::array<std::bitset<kMaxBins>, 2> covered;
  const Eigen::Matrix2d rotation = pose.rotation();
  for (const EdgePoint& edge : edges) {
    const Eigen::Vector2d offset = edge.position_m - pose.translation();
    const Eigen::Vector2d p = rotation.transpose() * offset;
    const Eigen::Vector2d n = rotation.transpose() * edge.normal;
    for (int arm = 0; arm < 2; ++arm) {  // arm 0 along +x, its distance is p.y; arm 1 along +y
      const double along = p[arm], away = p[1 - arm];
      if (along < 0 || along >= params.arm_length_m || std::abs(away) > params.polish_reach_m) continue;
      if (facing * n[1 - arm] < kFacesArmCosine) continue;
      covered[static_cast<std::size_t>(arm)].set(
          static_cast<std::size_t>(along / params.arm_length_m * bins));
      const Eigen::Vector2d axis = rotation.col(1 - arm);
      // The distance away = axis . (edge - apex) falls as the apex moves along the axis, and turns with the
      // arm.
      const Eigen::Vector3d row(-axis.x(), -axis.y(), arm == 0 ? -along : along);
      evidence.information += row * row.transpose();
      evidence.gradient += row * away;
      evidence.squares_m2 += away * away;
      ++evidence.count;
      break;
    }
  }
  for (std::size_t arm = 0; arm < 2; ++arm)
    evidence.support[arm] = static_cast<double>(covered[arm].count()) / bins;
  return evidence;
}

}  // namespace

CornerFitter::CornerFitter(const DistanceField& field, const EdgeIndex& index, const GridGeometry& geometry,
                           const LandmarkParams& params)
    : geometry_(geometry),
      params_(params),
      index_(index),
      cost_(field, params.arm_length_m / geometry.resolution_m, pointsPerArm(params), params.stabiliser),
      residuals_(cost_.num_residuals()),
      jacobian_(cost_.num_residuals(), 3) {}

Pose2 CornerFitter::approach(const Pose2& guess) {
  const Eigen::Vector2d cells = geometry_.toCells(guess.translation());
  Eigen::Vector3d x(cells.x(), cells.y(), guess.yaw_rad * 180 / M_PI);
  double* jacobians[] = {jacobian_.data()};
  for (int i = 0; i < params_.max_iterations; ++i) {
    cost_.setPrevious(x);  // the stabiliser holds each step, not the way from the guess
    const double* block = x.data();
    cost_.Evaluate(&block, residuals_.data(), jacobians);
    // (J'J + W'W) (x_next - x) = -J'e: W'W comes with the stabiliser's rows of J, whose residuals are 0 here.
    const Eigen::Vector3d step = jacobian_.transpose().lazyProduct(jacobian_).eval().ldlt().solve(
        -(jacobian_.transpose() * residuals_));
    x += step;
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
  const Eigen::Vector2d apex = geometry_.toMetres(x.head<2>());
  return {apex.x(), apex.y(), wrapAngle(x[2] * M_PI / 180)};
}

// Of either facing, the edges that may lie beside the arms while the corner settles; none where edges do not
// cover the arms.
const CornerFitter::EdgesByFacing& CornerFitter::edgesAround(const Pose2& corner) {
  const double reach_m =
      params_.dilation_m + params_.polish_reach_m;  // a step, then the search beside the arms
  const int bins = binsOf(params_);
  const Eigen::Matrix2d rotation = corner.rotation();
  for (std::vector<EdgePoint>& edges : around_) edges.clear();
  std::array<std::array<std::bitset<kMaxBins>, 2>, 2> covered;
  const double half_m = (0.5 * params_.arm_length_m + reach_m) * rotation.row(0).cwiseAbs().sum();
  const Eigen::Vector2d middle = corner * Eigen::Vector2d::Constant(0.5 * params_.arm_length_m);
  index_.forEachNear(middle, half_m, [&](const EdgePoint& edge) {
    const Eigen::Vector2d p = rotation.transpose() * (edge.position_m - corner.translation());
    const double least = std::min(p.x(), p.y()), most = std::max(p.x(), p.y());
    if (std::abs(least) > reach_m || most > params_.arm_length_m + reach_m) return;
    const Eigen::Vector2d n = rotation.transpose() * edge.normal;
    bool belongs[2] = {false, false};
    for (int arm = 0; arm < 2; ++arm) {
      const double faces = n[1 - arm], along = p[arm], away = std::abs(p[1 - arm]);
      if (std::abs(faces) < kMayFaceArmCosine || away > reach_m) continue;
      const std::size_t facing = faces > 0 ? 0 : 1;
      belongs[facing] = true;
      if (along >= 0 && along < params_.arm_length_m && away <= params_.polish_reach_m &&
          std::abs(faces) >= kFacesArmCosine)
        covered[facing][static_cast<std::size_t>(arm)].set(
            static_cast<std::size_t>(along / params_.arm_length_m * bins));
    }
    for (std::size_t facing = 0; facing < 2; ++facing)
      if (belongs[facing]) around_[facing].push_back(edge);
  });
  for (std::size_t facing = 0; facing < 2; ++facing)
    if (static_cast<double>(std::min(covered[facing][0].count(), covered[facing][1].count())) <
        params_.min_support * bins)
      around_[facing].clear();
  return around_;
}

std::optional<CornerLandmark> CornerFitter::settle(const Pose2& near, const std::vector<EdgePoint>& edges,
                                                   CornerKind kind) const {
  const double facing = kind == CornerKind::kInsideFree ? 1 : -1;
  if (edges.empty()) return std::nullopt;
  Pose2 pose = near;
  ArmEvidence evidence;
  for (int round = 0; round <= kSettleRounds; ++round) {
    evidence = gather(edges, pose, facing, params_);
    if (std::min(evidence.support[0], evidence.support[1]) < params_.min_support) return std::nullopt;
    if (round == kSettleRounds) break;
    const Eigen::Vector3d step = evidence.information.ldlt().solve(-evidence.gradient);
    if (!step.allFinite() || step.head<2>().norm() > params_.dilation_m + params_.polish_reach_m)
      return std::nullopt;
    pose = {pose.x_m + step[0], pose.y_m + step[1], wrapAngle(pose.yaw_rad + step[2])};
  }
  CornerLandmark corner;
  corner.pose = pose;
  corner.kind = kind;
  corner.rms_m = std::sqrt(evidence.squares_m2 / evidence.count);
  if (corner.rms_m > params_.max_rms_cells * geometry_.resolution_m) return std::nullopt;
  // Edges within the smoothing radius share their cells: so many count as one. A cell's quantisation is the
  // floor.
  const double correlated = std::max(2 * params_.edges.smoothing_m / geometry_.resolution_m, 1.0);
  const double variance_m2 =
      corner.rms_m * corner.rms_m + geometry_.resolution_m * geometry_.resolution_m / 12;
  corner.covariance = correlated * variance_m2 * evidence.information.inverse();
  return corner;
}

std::vector<CornerLandmark> CornerFitter::fit(const Pose2& guess) {
  const Pose2 near = approach(guess);
  const EdgesByFacing& edges = edgesAround(near);
  std::vector<CornerLandmark> corners;
  for (std::size_t facing = 0; facing < 2; ++facing) {
    const CornerKind kind = facing == 0 ? CornerKind::kInsideFree : CornerKind::kInsideSolid;
    if (const auto corner = settle(near, edges[facing], kind)) corners.push_back(*corner);
  }
  return corners;
}

}  // namespace cornerstone
