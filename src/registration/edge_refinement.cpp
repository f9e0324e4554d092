#include "cornerstone/registration/edge_refinement.h"

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_cost_function_adapter.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "cornerstone/registration/line_cost.h"

namespace cornerstone {
namespace {

using Adapter = ceres::TinySolverCostFunctionAdapter<Eigen::Dynamic, 3>;

constexpr std::size_t kMinPartners = 10;
constexpr double kTile_m = 3;  // about a wall

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

// Cauchy weights for the scatter that the pairs show, and more near the focus.
void weigh(std::vector<LinePair>& pairs, const Eigen::Vector3d& x, const Focus& focus) {
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
}

Pose2 poseAt(const Eigen::Vector3d& x, const Eigen::Vector2d& pivot_m) {
  const Pose2 turn{0, 0, wrapAngle(x[2])};
  const Eigen::Vector2d shift = x.head<2>() - turn * pivot_m;
  return {shift.x(), shift.y(), turn.yaw_rad};
}

using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// Neighbouring edges err together: where the maps bend, by whole walls. The scatter of the sums J'r over
// squares of some metres is what the pose's covariance must carry (the cluster-robust covariance of least
// squares).
Eigen::Matrix3d scatterOfTiles(const std::vector<LinePair>& pairs, const Jacobian& jacobian,
                               const Eigen::VectorXd& residuals) {
  std::map<std::pair<int, int>, Eigen::Vector3d> sums;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector2d square = pairs[i].current_m / kTile_m;
    const auto place =
        sums.try_emplace({static_cast<int>(std::floor(square.y())), static_cast<int>(std::floor(square.x()))},
                         Eigen::Vector3d::Zero())
            .first;
    const auto row = static_cast<Eigen::Index>(i);
    place->second += jacobian.row(row).transpose() * residuals[row];
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& entry : sums) scatter += entry.second * entry.second.transpose();
  const auto tiles = static_cast<double>(sums.size());
  return scatter * tiles / std::max(tiles - 3, 1.0);  // three parameters are fitted to them
}

void judge(const std::vector<LinePair>& pairs, const Eigen::Vector3d& x, const Eigen::Vector2d& pivot_m,
           RefinedPose& refined) {
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::VectorXd residuals(count);
  Jacobian jacobian(count, 3);
  const double* block = x.data();
  double* jacobians[] = {jacobian.data()};
  LineCost(pairs).Evaluate(&block, residuals.data(), jacobians);
  double weights = 0;
  for (const LinePair& pair : pairs) weights += pair.weight * pair.weight;
  refined.rms_m = std::sqrt(residuals.squaredNorm() / weights);
  refined.partners = static_cast<int>(count);
  const Eigen::Matrix3d information = jacobian.transpose() * jacobian;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(information.topLeftCorner<2, 2>());
  refined.spread = axes.eigenvalues()[0] / axes.eigenvalues()[1];
  const Eigen::Matrix3d inverse = information.inverse();
  // Both maps' edges see the same walls, so each pair counts half.
  const Eigen::Matrix3d at_pivot = 2 * refined.rms_m * refined.rms_m * inverse +
                                   inverse * scatterOfTiles(pairs, jacobian, residuals) * inverse;
  // From the pivot to the current map's origin.
  const Eigen::Vector2d lever = Pose2{0, 0, x[2]} * Eigen::Vector2d(-pivot_m);
  Eigen::Matrix3d by_pivot = Eigen::Matrix3d::Identity();
  by_pivot(0, 2) = -lever.y();
  by_pivot(1, 2) = lever.x();
  refined.covariance = by_pivot * at_pivot * by_pivot.transpose();
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
  for (int round = 0; round < options.rounds; ++round) {
    const double share = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1;
    const double reach_m =
        options.first_reach_m * std::pow(options.last_reach_m / options.first_reach_m, share);
    // The first rounds find the place, the last two its millimetres.
    const std::size_t edges = round + 2 < options.rounds ? options.max_edges / 4 : options.max_edges;
    pairs = pairing.under(poseAt(x, pivot_m), reach_m, edges);
    if (pairs.size() < kMinPartners) return std::nullopt;
    weigh(pairs, x, focus);
    const LineCost cost(pairs);
    const Adapter adapter(cost);
    ceres::TinySolver<Adapter> solver;
    solver.options.max_num_iterations = 2;  // one step: partners are chosen anew after it
    solver.Solve(adapter, &x);
    if (!x.allFinite()) return std::nullopt;
  }
  RefinedPose refined;
  refined.reference_from_current = poseAt(x, pivot_m);
  judge(pairs, x, pivot_m, refined);
  if (!refined.covariance.allFinite()) return std::nullopt;
  return refined;
}

}  // namespace cornerstone
