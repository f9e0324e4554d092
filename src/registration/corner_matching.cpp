#include "cornerstone/registration/corner_matching.h"

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_cost_function_adapter.h>

#include <cmath>

#include "cornerstone/registration/line_cost.h"

namespace cornerstone {
namespace {

// The nearest corner of `others` to each of `corners` carried by a pose; -1: none within the limits.
std::vector<int> nearestOf(const std::vector<CornerLandmark>& corners,
                           const std::vector<CornerLandmark>& others, const Pose2& others_from_corners,
                           const PairingLimits& limits) {
  std::vector<int> nearest;
  for (const CornerLandmark& corner : corners) {
    const Pose2 expected = others_from_corners * corner.pose;
    double best_m = limits.distance_m;
    int partner = -1;
    for (std::size_t i = 0; i < others.size(); ++i) {
      const double distance_m = (others[i].pose.translation() - expected.translation()).norm();
      if (others[i].kind != corner.kind || distance_m > best_m) continue;
      if (std::abs(wrapAngle(others[i].pose.yaw_rad - expected.yaw_rad)) > limits.angle_rad) continue;
      best_m = distance_m;
      partner = static_cast<int>(i);
    }
    nearest.push_back(partner);
  }
  return nearest;
}

}  // namespace

CornerPairs pairNearest(const std::vector<CornerLandmark>& reference,
                        const std::vector<CornerLandmark>& current, const Pose2& pose,
                        const PairingLimits& limits) {
  const std::vector<int> of_current = nearestOf(current, reference, pose, limits);
  const std::vector<int> of_reference = nearestOf(reference, current, pose.inverse(), limits);
  CornerPairs pairs;
  for (std::size_t c = 0; c < current.size(); ++c)
    if (of_current[c] >= 0 && of_reference[static_cast<std::size_t>(of_current[c])] == static_cast<int>(c))
      pairs.emplace_back(of_current[c], static_cast<int>(c));
  return pairs;
}

std::optional<Pose2> solvePairs(const std::vector<CornerLandmark>& reference,
                                const std::vector<CornerLandmark>& current, const CornerPairs& pairs,
                                const Pose2& guess) {
  if (pairs.size() < 2) return std::nullopt;
  Eigen::Vector2d pivot_m(0, 0);
  for (const auto& pair : pairs)
    pivot_m +=
        current[static_cast<std::size_t>(pair.second)].pose.translation() / static_cast<double>(pairs.size());
  std::vector<LinePair> lines;
  for (const auto& [r, c] : pairs) {
    const CornerLandmark& there = reference[static_cast<std::size_t>(r)];
    const CornerLandmark& here = current[static_cast<std::size_t>(c)];
    const double variance_m2 =
        0.5 * (there.covariance.topLeftCorner<2, 2>() + here.covariance.topLeftCorner<2, 2>()).trace();
    const double weight = 1 / std::sqrt(std::max(variance_m2, 1e-8));
    for (const Eigen::Vector2d& axis : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)})
      lines.push_back({here.pose.translation() - pivot_m, there.pose.translation(), axis, weight});
  }
  const LineCost cost(lines);
  using Adapter = ceres::TinySolverCostFunctionAdapter<Eigen::Dynamic, 3>;
  const Adapter adapter(cost);
  ceres::TinySolver<Adapter> solver;  // its trust region does what the paper's stabiliser does
  const Eigen::Vector2d start = guess * pivot_m;
  Eigen::Vector3d x(start.x(), start.y(), guess.yaw_rad);
  solver.Solve(adapter, &x);
  if (!x.allFinite()) return std::nullopt;
  const Eigen::Vector2d shift = x.head<2>() - Pose2{0, 0, x[2]} * pivot_m;
  return Pose2{shift.x(), shift.y(), wrapAngle(x[2])};
}

}  // namespace cornerstone
