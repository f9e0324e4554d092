#include "cornerstone/registration/edge_refinement.h"

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_cost_function_adapter.h>

#include <algorithm>
#include <cmath>

#include "cornerstone/registration/line_cost.h"
#include "cornerstone/registration/pose_covariance.h"

namespace cornerstone {
namespace {

using Adapter = ceres::TinySolverCostFunctionAdapter<Eigen::Dynamic, 3>;

constexpr std::size_t kMinPartners = 10;

// Factor of the residuals around a point.
struct Focus {
  std::optional<Eigen::Vector2d> at_m;  // relative to the pivot
  double radius_m;

  double factorAt(const Eigen::Vector2d& current_m) const {
    if (!at_m) return 1;
    return std::exp(-(current_m - *at_m).squaredNorm() /
                    (4 * radius_m * radius_m));  // its square is Gaussian
  }
};

struct Pairing {
  const EdgeIndex& reference;
  const EdgeIndex& current;
  Eigen::Vector2d pivot_m;

  // Edges of each map with the nearest one of the other under a pose.
  std::vector<LinePair> under(const Pose2& reference_from_current, double reach_m,
                              std::size_t max_edges) const {
    std::vector<LinePair> pairs;
    pairs.reserve(2 * max_edges);
    const Eigen::Matrix2d turn = reference_from_current.rotation();
    forEachPartner({current, reference, reference_from_current, reach_m, max_edges},
                   [&](const EdgePoint& here, const EdgePoint& there, const Eigen::Vector2d& normal) {
                     pairs.push_back({here.position_m - pivot_m, there.position_m, normal, 1});
                   });
    forEachPartner({reference, current, reference_from_current.inverse(), reach_m, max_edges},
                   [&](const EdgePoint& there, const EdgePoint& here, const Eigen::Vector2d& normal) {
                     pairs.push_back({here.position_m - pivot_m, there.position_m, turn * normal, 1});
                   });
    return pairs;
  }

 private:
  struct Way {
    const EdgeIndex& from;
    const EdgeIndex& to;
    Pose2 to_from_from;
    double reach_m;
    std::size_t max_edges;
  };
  template <typename Use>  // of an edge, its partner, and the normal of their line in the partner's map
  void forEachPartner(const Way& way, const Use& use) const {
    const auto& [from, to, to_from_from, reach_m, max_edges] = way;
    const Eigen::Matrix2d turn = to_from_from.rotation();
    const std::size_t step = (from.edges().size() + max_edges - 1) / max_edges;
    for (std::size_t i = 0; i < from.edges().size(); i += step) {
      const EdgePoint& edge = from.edges()[i];
      const Eigen::Vector2d normal = turn * edge.normal;
      const EdgePoint* partner = to.nearest(to_from_from * edge.position_m, normal, reach_m);
      if (partner != nullptr) use(edge, *partner, (normal + partner->normal).normalized());
    }
  }
};

// Cauchy weights for the scatter that the pairs show, and more near the focus. Gives the scatter.
double weigh(std::vector<LinePair>& pairs, const Eigen::Vector3d& x, const Focus& focus) {
  std::vector<double> residuals(pairs.size());
  for (LinePair& pair : pairs) pair.weight = 1;
  const double* block = x.data();
  LineCost(pairs).Evaluate(&block, residuals.data(), nullptr);
  std::vector<double> sizes(residuals.size());
  std::transform(residuals.begin(), residuals.end(), sizes.begin(), [](double r) { return std::abs(r); });
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  const double scale =
      std::max(1.4826 * sizes[sizes.size() / 2], 1e-3);  // of a normal distribution with this median
  for (std::size_t i = 0; i < pairs.size(); ++i)
    pairs[i].weight =
        focus.factorAt(pairs[i].current_m) / std::sqrt(1 + residuals[i] * residuals[i] / (scale * scale));
  return scale;
}

Pose2 poseAt(const Eigen::Vector3d& x, const Eigen::Vector2d& pivot_m) {
  const Pose2 turn{0, 0, wrapAngle(x[2])};
  const Eigen::Vector2d shift = x.head<2>() - turn * pivot_m;
  return {shift.x(), shift.y(), turn.yaw_rad};
}

}  // namespace

std::optional<RefinedPose> refineOnEdges(const EdgeIndex& reference, const EdgeIndex& current,
                                         const Pose2& guess, const RefinementOptions& options) {
  Eigen::Vector2d pivot_m(0, 0);
  for (const EdgePoint& edge : current.edges())
    pivot_m += edge.position_m / static_cast<double>(current.edges().size());
  Focus focus{std::nullopt, options.focus_radius_m};
  if (options.focus_in_current_m) focus.at_m = *options.focus_in_current_m - pivot_m;
  const Pairing pairing{reference, current, pivot_m};
  const Eigen::Vector2d start = guess * pivot_m;
  Eigen::Vector3d x(start.x(), start.y(), guess.yaw_rad);
  std::vector<LinePair> pairs;
  double scale_m = 0;
  for (int round = 0; round < options.rounds; ++round) {
    const double share = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1;
    const double reach_m =
        options.first_reach_m * std::pow(options.last_reach_m / options.first_reach_m, share);
    // The first rounds find the place, the last two its millimetres.
    const std::size_t edges = round + 2 < options.rounds ? options.max_edges / 4 : options.max_edges;
    pairs = pairing.under(poseAt(x, pivot_m), reach_m, edges);
    if (pairs.size() < kMinPartners) return std::nullopt;
    scale_m = weigh(pairs, x, focus);
    const LineCost cost(pairs);
    const Adapter adapter(cost);
    ceres::TinySolver<Adapter> solver;
    solver.options.max_num_iterations = 2;  // one step: partners are chosen anew after it
    solver.Solve(adapter, &x);
    if (!x.allFinite()) return std::nullopt;
  }
  RefinedPose refined;
  refined.reference_from_current = poseAt(x, pivot_m);
  const FitQuality quality = judgeFit({pairs, x, scale_m, options.cell_m});
  // From the pivot to the current map's origin.
  refined.covariance = composeCovariance({x[0], x[1], x[2]}, quality.covariance,
                                         {-pivot_m.x(), -pivot_m.y(), 0}, Eigen::Matrix3d::Zero());
  refined.rms_m = quality.rms_m;
  refined.spread = quality.spread;
  refined.partners = static_cast<int>(pairs.size());
  if (!refined.covariance.allFinite()) return std::nullopt;
  return refined;
}

}  // namespace cornerstone
