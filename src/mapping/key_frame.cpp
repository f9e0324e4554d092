#include "cornerstone/mapping/key_frame.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

struct Beams {
  const std::vector<Beam>& beams;
  std::vector<Eigen::Vector2d> ends_m;  // in the sensor frame
};

Beams withEnds(const std::vector<Beam>& beams) {
  Beams all{beams, {}};
  all.ends_m.reserve(beams.size());
  for (const Beam& beam : beams)
    all.ends_m.push_back(beam.range_m *
                         Eigen::Vector2d(std::cos(beam.bearing_rad), std::sin(beam.bearing_rad)));
  return all;
}

// In the sensor frame; not valid where neighbours have no answer or do not lie on one line.
WallPiece pieceAt(const Beams& all, std::size_t i, const WallPieceParams& params) {
  const auto& [beams, ends_m] = all;
  WallPiece piece;
  const auto reach = static_cast<std::size_t>(params.beams_each_side);
  const Beam& middle = beams[i];
  if (!middle.hit || middle.range_m > params.max_range_m || i < reach || i + reach >= beams.size())
    return piece;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  std::size_t count = 0;
  for (std::size_t k = i - reach; k <= i + reach; ++k) {
    if (!beams[k].hit) continue;
    sum += ends_m[k];
    squares += ends_m[k] * ends_m[k].transpose();
    ++count;
  }
  if (count < 2 * reach) return piece;  // all but one
  const Eigen::Vector2d mean_m = sum / static_cast<double>(count);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(squares / static_cast<double>(count) - mean_m * mean_m.transpose());
  const Eigen::Vector2d normal = axes.eigenvectors().col(0);
  const double incidence = std::abs(normal.dot(ends_m[i].normalized()));
  const double scatter_m = std::sqrt(std::max(0.0, axes.eigenvalues()(0)));
  const double along = std::sqrt(std::max(0.0, 1 - incidence * incidence));
  const double bearing_m = params.bearing_sigma_beams * middle.width_rad * middle.range_m;
  const double across_m = std::hypot(middle.sigma_m * incidence, bearing_m * along);
  if (incidence < params.min_incidence ||
      scatter_m > params.max_sigmas * middle.sigma_m * incidence + params.max_scatter_m)
    return piece;
  const double range_m = mean_m.norm(), bearing_rad = std::atan2(mean_m.y(), mean_m.x());
  const Eigen::Matrix2d by_calibration =
      mean_m.normalized() * rangeByCalibration(range_m, bearing_rad).transpose();
  return {mean_m, normal, across_m, by_calibration, true};
}

WallPiece moved(const PointMotion& base_from_sensor, const WallPiece& piece) {
  if (!piece.valid) return {};
  const Eigen::Matrix2d& rotation = base_from_sensor.rotation;
  return {base_from_sensor * piece.point_m, rotation * piece.normal, piece.sigma_m,
          rotation * piece.by_calibration, piece.valid};
}

}  // namespace

void describe(ParamVisitor& visitor, WallPieceParams& params) {
  visitor.field("beams_each_side", params.beams_each_side);
  visitor.field("max_sigmas", params.max_sigmas);
  visitor.field("max_scatter_m", params.max_scatter_m);
  visitor.field("max_range_m", params.max_range_m);
  visitor.field("bearing_sigma_beams", params.bearing_sigma_beams);
  visitor.field("min_incidence", params.min_incidence);
}

void requireValid(const WallPieceParams& params) {
  requireWithin(params.beams_each_side, 1, 100, "beams_each_side");
  requireWithin(params.max_sigmas, 0, 100, "max_sigmas");
  requireWithin(params.max_scatter_m, 0, 1, "max_scatter_m");
  requirePositive(params.max_range_m, "max_range_m");
  requireWithin(params.bearing_sigma_beams, 0, 100, "bearing_sigma_beams");
  requireWithin(params.min_incidence, 0, 1, "min_incidence");
}

KeyFrame makeKeyFrame(const RangeScan& scan, const Pose2& odom_from_base, const Pose2& map_from_base,
                      const WallPieceParams& params) {
  KeyFrame frame;
  frame.odom_from_base = odom_from_base;
  frame.map_from_base = map_from_base;
  frame.base_from_sensor = scan.base_from_sensor;
  frame.correlated_beams = std::max(1.0, scan.correlated_beams);
  frame.calibration_sigma_per_m = scan.calibration_sigma_per_m;
  const PointMotion base_from_sensor(scan.base_from_sensor);
  const Beams beams = withEnds(scan.beams);
  std::vector<double> bearings_rad;
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    bearings_rad.push_back(scan.beams[i].bearing_rad);
    WallPiece piece = pieceAt(beams, i, params);
    // Nothing is asked of a laser's calibration; at 90 degrees its derivative would have no bound.
    if (scan.calibration_sigma_per_m == 0) piece.by_calibration.setZero();
    frame.pieces.push_back(moved(base_from_sensor, piece));
  }
  frame.bearings = BearingIndex(bearings_rad);
  frame.looks.push_back({std::make_shared<const RangeScan>(scan), {}});
  return frame;
}

}  // namespace cornerstone
