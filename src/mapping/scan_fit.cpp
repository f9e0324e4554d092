#include "cornerstone/mapping/scan_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/point_to_line_cost.h"
#include "surface_lines.h"

namespace cornerstone {
namespace {

struct BeamEnd {
  Eigen::Vector2d in_base_m;
  Eigen::Vector2d direction_in_base;
  double sigma_m = 0;
};

// The inverse range of a straight surface runs evenly over the bearing: its second difference vanishes. At
// depth edges and corners it does not, and there stereo sees another shape from every place.
bool straightAround(const std::vector<Beam>& beams, std::size_t i, const ScanFitParams& params) {
  const auto reach = static_cast<std::size_t>(params.straight_beams);
  if (reach == 0) return true;
  if (i < reach || i + reach >= beams.size()) return false;
  const Beam &before = beams[i - reach], &middle = beams[i], &after = beams[i + reach];
  if (!before.hit || !after.hit) return false;
  const double bend = 1 / before.range_m + 1 / after.range_m - 2 / middle.range_m;
  return std::abs(bend) * middle.range_m * middle.range_m < params.straight_sigmas * middle.sigma_m;
}

std::vector<BeamEnd> endsOf(const RangeScan& scan, const GridParams& grid, const ScanFitParams& params) {
  std::vector<BeamEnd> ends;
  const PointMotion base_from_sensor(scan.base_from_sensor);
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    if (!beam.hit || beam.range_m > grid.max_range_m || !straightAround(scan.beams, i, params)) continue;
    const Eigen::Vector2d direction(std::cos(beam.bearing_rad), std::sin(beam.bearing_rad));
    ends.push_back(
        {base_from_sensor * (beam.range_m * direction), base_from_sensor.rotation * direction, beam.sigma_m});
  }
  return ends;
}

SurfaceLines surfacesAround(const std::vector<BeamEnd>& ends, const OccupancyGrid& grid,
                            const Pose2& map_from_base, const ScanFitParams& params) {
  const PointMotion to_map(map_from_base);
  Eigen::Vector2d low_m = map_from_base.translation(), high_m = low_m;
  for (const BeamEnd& end : ends) {
    const Eigen::Vector2d end_m = to_map * end.in_base_m;
    low_m = low_m.cwiseMin(end_m);
    high_m = high_m.cwiseMax(end_m);
  }
  const double margin_m = 2 * params.gate_m + params.line_radius_m;
  return {grid, low_m.array() - margin_m, high_m.array() + margin_m, params.line_radius_m};
}

std::vector<LineMatch> pairEnds(const std::vector<BeamEnd>& ends, const SurfaceLines& surfaces,
                                const Pose2& pose, const ScanFitParams& params) {
  const PointMotion to_map(pose);
  std::vector<LineMatch> matches;
  for (const BeamEnd& end : ends) {
    const auto line = surfaces.nearest(to_map * end.in_base_m, params.gate_m);
    if (!line) continue;
    const double across_m = end.sigma_m * line->normal.dot(to_map.rotation * end.direction_in_base);
    matches.push_back(
        {end.in_base_m, line->point_m, line->normal, std::hypot(across_m, params.surface_sigma_m)});
  }
  return matches;
}

double whitened(const LineMatch& match, const PointMotion& to_map) {
  return match.normal.dot(to_map * match.point_in_base_m - match.surface_m) / match.sigma_m;
}

// J' W J and J' W r of the distances to the lines; Cauchy's loss by weights. Neighbouring beams share their
// errors: together `correlated` of them are one measurement.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

NormalEquations equationsAt(const std::vector<LineMatch>& matches, const Pose2& pose, double correlated,
                            double loss_sigmas) {
  NormalEquations sums;
  const Eigen::Matrix2d rotation = pose.rotation();
  for (const LineMatch& match : matches) {
    const Eigen::Vector2d arm_m = rotation * match.point_in_base_m;
    const double residual_m = match.normal.dot(arm_m + pose.translation() - match.surface_m);
    const double sigmas = residual_m / (match.sigma_m * loss_sigmas);
    const double weight = 1 / ((1 + sigmas * sigmas) * match.sigma_m * match.sigma_m * correlated);
    const Eigen::Vector3d row(match.normal.x(), match.normal.y(),
                              match.normal.y() * arm_m.x() - match.normal.x() * arm_m.y());
    sums.information += weight * row * row.transpose();
    sums.gradient += weight * residual_m * row;
  }
  return sums;
}

Eigen::Vector3d differenceOf(const Pose2& pose, const Pose2& from) {
  return {pose.x_m - from.x_m, pose.y_m - from.y_m, wrapAngle(pose.yaw_rad - from.yaw_rad)};
}

// Gauss-Newton with the weights of the pose before: three steps bring it as near as pairing anew can use.
Pose2 solve(const std::vector<LineMatch>& matches, const Pose2& start, const PoseEstimate& prior,
            const ScanFitParams& params, double correlated) {
  constexpr int kSteps = 3;
  const Eigen::Matrix3d prior_information = prior.covariance.inverse();
  Pose2 pose = start;
  for (int i = 0; i < kSteps; ++i) {
    const NormalEquations sums = equationsAt(matches, pose, correlated, params.loss_sigmas);
    const Eigen::Vector3d step =
        -(sums.information + prior_information)
             .ldlt()
             .solve(sums.gradient + prior_information * differenceOf(pose, prior.map_from_base));
    pose = {pose.x_m + step.x(), pose.y_m + step.y(), wrapAngle(pose.yaw_rad + step.z())};
  }
  return pose;
}

// What the information of a look amounts to, with what one look cannot know (F) and what it repeats (new
// share n): n (I + L F)^-1 is what L has to be multiplied with.
Eigen::Matrix3d temperOf(const Eigen::Matrix3d& information, double new_share, const ScanFitParams& params) {
  const Eigen::Matrix3d floor =
      Eigen::Vector3d(params.look_sigma_m, params.look_sigma_m, params.look_sigma_rad)
          .cwiseAbs2()
          .asDiagonal();
  return new_share * (Eigen::Matrix3d::Identity() + information * floor).inverse();
}

// The solution takes the scan at its word, L for its information. Its temper T leaves L' = T L, which holds
// where L has no rank too. With P the prior's information, d the solution's step from the prior:
// L (scan - prior) = (L + P) d, and the step that L' allows is
//   d' = (L' + P)^-1 T (L + P) d.
PoseEstimate tempered(const Pose2& solution, const Eigen::Matrix3d& information, const ScanFitStart& start,
                      const ScanFitParams& params) {
  const Eigen::Matrix3d prior = start.prior.covariance.inverse();
  const Eigen::Matrix3d temper = temperOf(information, start.new_share, params);
  const Pose2& from = start.prior.map_from_base;
  const Eigen::Vector3d step = differenceOf(solution, from);
  const Eigen::Matrix3d covariance = (temper * information + prior).inverse();
  const Eigen::Vector3d allowed = covariance * temper * (information + prior) * step;
  return {{from.x_m + allowed.x(), from.y_m + allowed.y(), wrapAngle(from.yaw_rad + allowed.z())},
          (covariance + covariance.transpose()) / 2};
}

// How far scan and prior lie apart, in their common sigmas. With g = L' (scan - prior) = T (L + P) d, and C
// the prior's covariance, the sum of both covariances' inverse is (I + L' C)^-1 L', so that
//   |scan - prior|^2 = g' (L' + L' C L')^+ g.
double innovationOf(const Pose2& solution, const Eigen::Matrix3d& information, const ScanFitStart& start,
                    const ScanFitParams& params) {
  const Eigen::Matrix3d temper = temperOf(information, 1, params);
  const Eigen::Matrix3d& covariance = start.prior.covariance;
  const Eigen::Matrix3d known = temper * information;
  const Eigen::Vector3d pull =
      temper * (information + covariance.inverse()) * differenceOf(solution, start.prior.map_from_base);
  const Eigen::Matrix3d spread = known + known * covariance * known.transpose();
  const Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> decomposed((spread + spread.transpose()) / 2);
  return std::sqrt(std::max(0.0, pull.dot(decomposed.solve(pull))));
}

// Ends on free floor, farther than the gate from every surface.
int countOnFree(const std::vector<BeamEnd>& ends, const SurfaceLines& surfaces, const Pose2& pose,
                const ScanFitParams& params) {
  const PointMotion to_map(pose);
  int count = 0;
  for (const BeamEnd& end : ends) count += surfaces.isFree(to_map * end.in_base_m, params.gate_m);
  return count;
}

double agreeingShare(const std::vector<LineMatch>& matches, const Pose2& pose) {
  const PointMotion to_map(pose);
  int agreeing = 0;
  for (const LineMatch& match : matches) agreeing += std::abs(whitened(match, to_map)) < 3;
  return matches.empty() ? 0 : static_cast<double>(agreeing) / static_cast<double>(matches.size());
}

}  // namespace

void describe(ParamVisitor& visitor, ScanFitParams& params) {
  visitor.field("gate_m", params.gate_m);
  visitor.field("line_radius_m", params.line_radius_m);
  visitor.field("surface_sigma_m", params.surface_sigma_m);
  visitor.field("loss_sigmas", params.loss_sigmas);
  visitor.field("min_agreeing_share", params.min_agreeing_share);
  visitor.field("min_matches", params.min_matches);
  visitor.field("max_rounds", params.max_rounds);
  visitor.field("straight_beams", params.straight_beams);
  visitor.field("straight_sigmas", params.straight_sigmas);
  visitor.field("look_sigma_m", params.look_sigma_m);
  visitor.degrees("look_sigma_deg", params.look_sigma_rad);
}

void requireValid(const ScanFitParams& params) {
  requireWithin(params.gate_m, 0.02, 2, "gate_m");
  requireWithin(params.line_radius_m, 0.05, 2, "line_radius_m");
  requireWithin(params.surface_sigma_m, 1e-4, 0.5, "surface_sigma_m");
  requireWithin(params.loss_sigmas, 0.1, 100, "loss_sigmas");
  requireWithin(params.min_agreeing_share, 0, 1, "min_agreeing_share");
  requireWithin(params.min_matches, 3, 10000, "min_matches");
  requireWithin(params.max_rounds, 1, 100, "max_rounds");
  requireWithin(params.straight_beams, 0, 100, "straight_beams");
  requireWithin(params.straight_sigmas, 0.1, 100, "straight_sigmas");
  requireWithin(params.look_sigma_m, 0, 1, "look_sigma_m");
  requireWithin(params.look_sigma_rad, 0, 1, "look_sigma_deg");
}

ScanFit fitScan(const RangeScan& scan, const OccupancyGrid& grid, const ScanFitStart& start,
                const ScanFitParams& params) {
  ScanFit fit;
  const PoseEstimate& prior = start.prior;
  fit.pose = prior;
  const std::vector<BeamEnd> ends = endsOf(scan, grid.params(), params);
  if (ends.empty() || grid.empty()) return fit;
  const SurfaceLines surfaces = surfacesAround(ends, grid, prior.map_from_base, params);
  const double correlated = std::max(1.0, scan.correlated_beams);
  Pose2 pose = prior.map_from_base;
  std::vector<LineMatch> matches;
  for (int round = 0; round < params.max_rounds; ++round) {
    matches = pairEnds(ends, surfaces, pose, params);
    if (static_cast<int>(matches.size()) < params.min_matches) break;
    const Pose2 before = pose;
    pose = solve(matches, pose, prior, params, correlated);
    if (!pose.isFinite()) return fit;
    const Pose2 moved = before.inverse() * pose;
    if (moved.translation().norm() < 5e-4 && std::abs(moved.yaw_rad) < 2e-4) break;
  }
  fit.matches = static_cast<int>(matches.size());
  fit.agreeing_share = agreeingShare(matches, pose);
  fit.on_free = countOnFree(ends, surfaces, pose, params);
  if (fit.matches < params.min_matches) return fit;
  fit.state = fit.agreeing_share < params.min_agreeing_share ? FitState::kContradicts : FitState::kFitted;
  if (fit.state != FitState::kFitted) return fit;
  const Eigen::Matrix3d information = equationsAt(matches, pose, correlated, params.loss_sigmas).information;
  fit.pose = tempered(pose, information, start, params);
  fit.innovation_sigmas = innovationOf(pose, information, start, params);
  return fit;
}

}  // namespace cornerstone
