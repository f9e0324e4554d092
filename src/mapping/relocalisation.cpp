#include "cornerstone/mapping/relocalisation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kWideStep_m = 0.25, kFineStep_m = 0.1;
constexpr double kWideStep_rad = 3 * M_PI / 180, kFineStep_rad = 1 * M_PI / 180;
constexpr double kWideReach_m = 0.25, kFineReach_m = 0.12;  // of a beam end to the surface it agrees with
constexpr std::size_t kBeams = 90;                          // that take part, spread over the look
constexpr std::size_t kKept = 24;                           // different poses that are sought again
// Of the fitted place, in its vaguest direction: a single wall (a board set up before the robot) fits in many
// places.
constexpr double kWidest_m = 0.1;
constexpr double kGain = 0.1;  // in agreement against odometry's pose
// What a search prefers to its edge, where all agree alike (along a corridor): odometry's pose.
constexpr double kNearness = 0.05;
constexpr double kDifferent_m = 0.5, kDifferent_rad = 15 * M_PI / 180;

struct Candidate {
  Pose2 map_from_base;
  double agreeing = 0;  // share of the ends on a surface, less those on free floor
};

bool different(const Pose2& a, const Pose2& b) {
  return (a.translation() - b.translation()).norm() > kDifferent_m ||
         std::abs(wrapAngle(a.yaw_rad - b.yaw_rad)) > kDifferent_rad;
}

std::vector<Eigen::Vector2d> endsOf(const RangeScan& scan, const GridParams& grid) {
  std::vector<Eigen::Vector2d> ends_m;
  for (const Beam& beam : scan.beams)
    if (beam.hit && beam.range_m <= grid.max_range_m && beam.sigma_m <= grid.max_sigma_m)
      ends_m.push_back(scan.base_from_sensor * (beam.range_m * Eigen::Vector2d(std::cos(beam.bearing_rad),
                                                                               std::sin(beam.bearing_rad))));
  if (ends_m.size() <= kBeams) return ends_m;
  std::vector<Eigen::Vector2d> spread;
  for (std::size_t i = 0; i < kBeams; ++i) spread.push_back(ends_m[i * ends_m.size() / kBeams]);
  return spread;
}

// What each cell says to a beam end that falls on it: +1 a surface within reach, -1 free floor, 0 unknown.
class Votes {
 public:
  Votes(const OccupancyGrid& grid, const CellWindow& window, double reach_m, double min_known_share)
      : at_(window.geometry), votes_(window.cells.size()), min_known_share_(min_known_share) {
    for (std::size_t i = 0; i < votes_.size(); ++i)
      votes_[i] = EvidenceScale::logOddsOf(window.cells[i]) < 0 ? -1 : 0;
    const std::vector<SurfacePoint> surface = grid.readSurface(window);
    for (int row = 0; row < at_.rows; ++row)
      for (int col = 0; col < at_.cols; ++col)
        if (surface[window.indexOf({col, row})].weight > 0) agreeAround({col, row}, reach_m);
  }

  double agreeing(const std::vector<Eigen::Vector2d>& ends_m, const Pose2& map_from_base) const {
    return agreeing(ends_m, map_from_base, min_known_share_);
  }

  // min_known_share: of the ends; where the map knows fewer, those missing count against the pose.
  double agreeing(const std::vector<Eigen::Vector2d>& ends_m, const Pose2& map_from_base,
                  double min_known_share) const {
    const Eigen::Matrix2d rotation = map_from_base.rotation();
    int sum = 0, known = 0;
    for (const Eigen::Vector2d& end_m : ends_m) {
      const Cell cell = at_.cellAt(rotation * end_m + map_from_base.translation());
      if (!at_.contains(cell)) continue;
      sum += votes_[indexOf(cell)];
      known += votes_[indexOf(cell)] != 0;
    }
    return sum / std::max<double>(known, min_known_share * static_cast<double>(ends_m.size()));
  }

 private:
  std::size_t indexOf(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(at_.cols) +
           static_cast<std::size_t>(cell.col);
  }

  void agreeAround(Cell centre, double reach_m) {
    const int reach = static_cast<int>(reach_m / at_.resolution_m);
    for (int row = -reach; row <= reach; ++row)
      for (int col = -reach; col <= reach; ++col) {
        const Cell cell{centre.col + col, centre.row + row};
        if (row * row + col * col <= reach * reach && at_.contains(cell)) votes_[indexOf(cell)] = 1;
      }
  }

  GridGeometry at_;
  std::vector<std::int8_t> votes_;
  double min_known_share_;
};

CellWindow windowAround(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& ends_m,
                        const Pose2& centre, double reach_m) {
  double farthest_m = 0;
  for (const Eigen::Vector2d& end_m : ends_m) farthest_m = std::max(farthest_m, end_m.norm());
  const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(farthest_m + reach_m + kWideReach_m);
  return grid.readWindow(centre.translation() - margin_m, centre.translation() + margin_m);
}

void sortByAgreement(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.agreeing > b.agreeing; });
}

// The best poses that differ from one another.
std::vector<Candidate> bestDifferent(std::vector<Candidate> candidates) {
  sortByAgreement(candidates);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    if (kept.size() == kKept) break;
    if (std::all_of(kept.begin(), kept.end(), [&](const Candidate& other) {
          return different(candidate.map_from_base, other.map_from_base);
        }))
      kept.push_back(candidate);
  }
  return kept;
}

struct Steps {
  double reach_m, step_m, reach_rad, step_rad;
};

std::vector<Candidate> search(const Votes& votes, const std::vector<Eigen::Vector2d>& ends_m,
                              const Pose2& centre, const Steps& steps) {
  const int places = static_cast<int>(std::ceil(steps.reach_m / steps.step_m));
  const int turns = static_cast<int>(std::ceil(steps.reach_rad / steps.step_rad));
  std::vector<Candidate> found;
  for (int turn = -turns; turn <= turns; ++turn)
    for (int row = -places; row <= places; ++row)
      for (int col = -places; col <= places; ++col) {
        const Pose2 pose{centre.x_m + col * steps.step_m, centre.y_m + row * steps.step_m,
                         wrapAngle(centre.yaw_rad + turn * steps.step_rad)};
        const double away = std::hypot(row, col) / std::max(1, places);
        found.push_back({pose, votes.agreeing(ends_m, pose) - kNearness * away});
      }
  return found;
}

double widest(const Eigen::Matrix3d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(covariance.topLeftCorner<2, 2>());
  return std::sqrt(std::max(0.0, axes.eigenvalues()(1)));
}

}  // namespace

void describe(ParamVisitor& visitor, RelocalisationParams& params) {
  visitor.field("slip_sigmas", params.slip_sigmas);
  visitor.field("doubtful_share", params.doubtful_share);
  visitor.field("slip_reach_m", params.slip_reach_m);
  visitor.degrees("slip_reach_deg", params.slip_reach_rad);
  visitor.field("reach_m", params.reach_m);
  visitor.field("min_agreeing_share", params.min_agreeing_share);
  visitor.field("min_agreeing_share_far", params.min_agreeing_share_far);
  visitor.field("max_rival_share", params.max_rival_share);
}

void requireValid(const RelocalisationParams& params) {
  requireWithin(params.slip_sigmas, 1, 1e6, "slip_sigmas");
  requireWithin(params.doubtful_share, 0, 1, "doubtful_share");
  requireWithin(params.slip_reach_m, 0, 10, "slip_reach_m");
  requireWithin(params.slip_reach_rad, 0, 3.2, "slip_reach_deg");
  requireWithin(params.reach_m, 0, 10, "reach_m");
  requireWithin(params.min_agreeing_share, 0.3, 1, "min_agreeing_share");
  requireWithin(params.min_agreeing_share_far, 0.3, 1, "min_agreeing_share_far");
  requireWithin(params.max_rival_share, 0, 1, "max_rival_share");
}

Relocalisation relocalise(const LookOnMap& look, const SearchWindow& around, const ScanFitParams& fit,
                          const RelocalisationParams& params) {
  const RangeScan& scan = look.scan;
  const OccupancyGrid& grid = look.grid;
  const std::vector<Eigen::Vector2d> ends_m = endsOf(scan, grid.params());
  if (!(around.reach_m > 0) || grid.empty() || static_cast<int>(ends_m.size()) < fit.min_matches) return {};
  const CellWindow window = windowAround(grid, ends_m, around.map_from_base, around.reach_m);
  const Votes wide(grid, window, kWideReach_m, around.min_known_share),
      fine(grid, window, kFineReach_m, around.min_known_share);
  std::vector<Candidate> best;
  for (const Candidate& start :
       bestDifferent(search(wide, ends_m, around.map_from_base,
                            {around.reach_m, kWideStep_m, around.reach_rad, kWideStep_rad}))) {
    std::vector<Candidate> near = search(fine, ends_m, start.map_from_base,
                                         {kWideStep_m / 2, kFineStep_m, kWideStep_rad, kFineStep_rad});
    sortByAgreement(near);
    best.push_back(near.front());
  }
  best = bestDifferent(best);
  // Vaguer than the search is coarse: the fit decides.
  const Eigen::Matrix3d vague =
      Eigen::Vector3d(2 * kWideStep_m, 2 * kWideStep_m, 2 * kWideStep_rad).cwiseAbs2().asDiagonal();
  const ScanFit fitted = fitScan(scan, grid, {{best.front().map_from_base, vague}, 1}, fit);
  const double agreeing = fine.agreeing(ends_m, fitted.pose.map_from_base);
  if (agreeing < params.min_agreeing_share) return {};
  const bool rivalled = best.size() > 1 && best[1].agreeing > params.max_rival_share * best[0].agreeing;
  const bool fits = fitted.state == FitState::kFitted && widest(fitted.pose.covariance) <= kWidest_m;
  Relocalisation found;
  found.agreeing = agreeing;
  found.elsewhere =
      agreeing >= fine.agreeing(ends_m, around.map_from_base, around.min_known_share_here) + kGain;
  found.here = !found.elsewhere && fits && !different(fitted.pose.map_from_base, around.map_from_base);
  if (found.elsewhere && fits && !rivalled) found.pose = fitted.pose;
  return found;
}

}  // namespace cornerstone
