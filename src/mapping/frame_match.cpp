#include "cornerstone/mapping/frame_match.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr int kRounds = 6;
constexpr int kWideRounds = 2;  // at the whole gate

struct Sums {
  Matrix5d squares = Matrix5d::Zero();   // J' W J
  Vector5d gradient = Vector5d::Zero();  // J' W r
  int in_view = 0;
  int met = 0;       // within the gate
  int agreeing = 0;  // within three sigmas
};

// One of two looks at a wall, along its normal.
struct LookAtWall {
  double to_other_m;  // to where the other look sees the wall
  double sigma_m;
  double away_m;  // of the wall from the sensor
};

// Errors of stereo and what the calibration moves grow with the range's square. Taken at the range that each
// look measured they would hang on its noise: a wall measured too near would weigh more and move less, so
// that walls would seem nearer than they are, and the calibration wrong. Hence both are taken where the two
// looks together see the wall: what each look's sigma and derivative have to be multiplied with.
std::pair<double, double> ratesAtMean(const LookAtWall& earlier, const LookAtWall& later) {
  const double e = earlier.sigma_m * earlier.sigma_m, l = later.sigma_m * later.sigma_m;
  const auto rate = [](const LookAtWall& look, double share) {
    constexpr double kLeast = 0.5, kMost = 2;  // of the range: beyond, it is not this wall
    const double ratio = std::clamp(1 + share * look.to_other_m / look.away_m, kLeast, kMost);
    return ratio * ratio;
  };
  return {rate(earlier, e / (e + l)), rate(later, l / (e + l))};
}

// A piece of the later look, corrected by the calibration, in its base frame.
struct LaterPiece {
  Eigen::Vector2d point_m;
  const WallPiece* piece;
};

class Matching {
 public:
  Matching(const KeyFrame& earlier, const KeyFrame& later, const ScanCalibration& calibration,
           const FrameMatchParams& params)
      : earlier_(earlier), later_(later), params_(params), to_sensor_(earlier.base_from_sensor.inverse()) {
    const Eigen::Vector2d by(calibration.offset_per_m, calibration.slope_per_m);
    walls_m_.reserve(earlier.pieces.size());
    for (const WallPiece& wall : earlier.pieces) walls_m_.push_back(wall.point_m + wall.by_calibration * by);
    pieces_.reserve(later.pieces.size());
    for (const WallPiece& piece : later.pieces)
      if (piece.valid) pieces_.push_back({piece.point_m + piece.by_calibration * by, &piece});
  }

  Sums sumAt(const Pose2& earlier_from_later, double gate_m) const {
    Sums sums;
    const PointMotion motion(earlier_from_later);
    const Eigen::Vector2d earlier_at_m = earlier_.base_from_sensor.translation();
    const Eigen::Vector2d later_at_m = motion * later_.base_from_sensor.translation();
    std::size_t beam = 0;
    for (const auto& [in_later_m, piece] : pieces_) {
      const Eigen::Vector2d arm_m = motion.rotation * in_later_m;
      const Eigen::Vector2d point_m = motion.translation_m + arm_m;
      const auto nearest = earlier_.bearings.nearest(to_sensor_ * point_m, beam);
      if (!nearest) continue;
      ++sums.in_view;
      beam = *nearest;
      const WallPiece& wall = earlier_.pieces[beam];
      if (!wall.valid) continue;
      const Eigen::Vector2d as_later = motion.rotation * piece->normal;
      const double cosine = wall.normal.dot(as_later);
      if (std::abs(cosine) < params_.min_normal_cosine) continue;
      // Of both looks: the noise of one normal alone pretends to see motion along the wall.
      const double e2 = wall.sigma_m * wall.sigma_m, l2 = piece->sigma_m * piece->sigma_m;
      const Eigen::Vector2d normal = (l2 * wall.normal + std::copysign(e2, cosine) * as_later).normalized();
      const Eigen::Vector2d& wall_m = walls_m_[beam];
      const double residual_m = normal.dot(point_m - wall_m);
      if (std::abs(residual_m) > gate_m) continue;
      const auto [by_earlier, by_later] =
          ratesAtMean({residual_m, wall.sigma_m, normal.dot(wall_m - earlier_at_m)},
                      {-residual_m, piece->sigma_m, normal.dot(point_m - later_at_m)});
      const double variance_m2 = std::pow(by_earlier * wall.sigma_m, 2) +
                                 std::pow(by_later * piece->sigma_m, 2) +
                                 params_.wall_sigma_m * params_.wall_sigma_m;
      const double loss =
          1 + residual_m * residual_m / (variance_m2 * params_.loss_sigmas * params_.loss_sigmas);
      const double weight = 1 / (loss * variance_m2 * later_.correlated_beams);
      Vector5d row;
      row << normal, normal.y() * arm_m.x() - normal.x() * arm_m.y(),
          (by_later * motion.rotation * piece->by_calibration - by_earlier * wall.by_calibration)
                  .transpose() *
              normal;
      sums.squares += weight * row * row.transpose();
      sums.gradient += weight * residual_m * row;
      ++sums.met;
      sums.agreeing += residual_m * residual_m < 9 * variance_m2;
    }
    return sums;
  }

 private:
  const KeyFrame& earlier_;
  const KeyFrame& later_;
  const FrameMatchParams& params_;
  PointMotion to_sensor_;                 // from the base, of the earlier look
  std::vector<Eigen::Vector2d> walls_m_;  // pieces of the earlier look, corrected by the calibration
  std::vector<LaterPiece> pieces_;        // that are valid
};

// To go on with: pieces within the gate. To be believed: pieces within three sigmas.
bool enough(const Sums& sums, const FrameMatchParams& params) {
  return sums.met >= params.min_pieces && sums.met >= params.min_agreeing_share * sums.in_view;
}

bool agree(const Sums& sums, const FrameMatchParams& params) {
  return sums.agreeing >= params.min_pieces && sums.agreeing >= params.min_agreeing_share * sums.in_view;
}

// The quadratic of the sums at their pose, tempered by the floor: information L becomes (I + L F)^-1 L.
FrameMatch quadraticOf(const Sums& sums, const Pose2& pose, const Eigen::Vector2d& calibration,
                       const FrameMatchParams& params) {
  Vector5d floor;
  floor << params.floor_sigma_m, params.floor_sigma_m, params.floor_sigma_rad, params.floor_calibration_per_m,
      params.floor_calibration_per_m;
  const Matrix5d temper =
      (Matrix5d::Identity() + sums.squares * floor.cwiseAbs2().asDiagonal().toDenseMatrix()).inverse();
  const Matrix5d information = temper * sums.squares;
  // In units of the floor all five directions are alike, and what is not observed shows as a zero.
  const Matrix5d scaled =
      floor.asDiagonal() * ((information + information.transpose()) / 2) * floor.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix5d> axes(scaled);
  constexpr double kObserved = 1e-6;  // a thousand times vaguer than the floor: as good as nothing
  const Vector5d along = axes.eigenvectors().transpose() * floor.asDiagonal() * (temper * sums.gradient);
  FrameMatch match;
  match.earlier_from_later = pose;
  match.pieces = sums.met;
  for (int i = 0; i < 5; ++i) {
    const double strength = std::sqrt(std::max(0.0, axes.eigenvalues()(i)));
    if (axes.eigenvalues()(i) < kObserved) continue;
    match.sqrt_information.row(i) =
        strength * axes.eigenvectors().col(i).transpose() * floor.cwiseInverse().asDiagonal();
    match.offset(i) = along(i) / strength;
  }
  match.offset -= match.sqrt_information.rightCols<2>() * calibration;
  return match;
}

}  // namespace

void describe(ParamVisitor& visitor, FrameMatchParams& params) {
  visitor.field("gate_m", params.gate_m);
  visitor.field("loss_sigmas", params.loss_sigmas);
  visitor.field("wall_sigma_m", params.wall_sigma_m);
  visitor.field("min_pieces", params.min_pieces);
  visitor.field("min_agreeing_share", params.min_agreeing_share);
  visitor.field("min_normal_cosine", params.min_normal_cosine);
  visitor.field("floor_sigma_m", params.floor_sigma_m);
  visitor.degrees("floor_sigma_deg", params.floor_sigma_rad);
  visitor.field("floor_calibration_per_m", params.floor_calibration_per_m);
}

void requireValid(const FrameMatchParams& params) {
  requireWithin(params.gate_m, 0.02, 5, "gate_m");
  requireWithin(params.loss_sigmas, 0.1, 100, "loss_sigmas");
  requireWithin(params.wall_sigma_m, 1e-4, 1, "wall_sigma_m");
  requireWithin(params.min_pieces, 3, 10000, "min_pieces");
  requireWithin(params.min_agreeing_share, 0, 1, "min_agreeing_share");
  requireWithin(params.min_normal_cosine, 0, 1, "min_normal_cosine");
  requireWithin(params.floor_sigma_m, 1e-5, 1, "floor_sigma_m");
  requireWithin(params.floor_sigma_rad, 1e-5, 1, "floor_sigma_deg");
  requireWithin(params.floor_calibration_per_m, 1e-6, 1, "floor_calibration_per_m");
}

std::optional<FrameMatch> matchFrames(const KeyFrame& earlier, const KeyFrame& later,
                                      const FrameMatchStart& start, const FrameMatchParams& params) {
  if (earlier.pieces.empty() || later.pieces.empty()) return std::nullopt;
  const Matching matching(earlier, later, start.calibration, params);
  Pose2 pose = start.earlier_from_later;
  for (int round = 0; round < kRounds; ++round) {
    const Sums sums = matching.sumAt(pose, round < kWideRounds ? params.gate_m : params.gate_m / 2);
    if (!enough(sums, params)) return std::nullopt;
    constexpr double kWeak = 1e-3;  // 1 / m^2 and 1 / rad^2: what is not observed stays as expected
    const Eigen::Matrix3d squares = sums.squares.topLeftCorner<3, 3>() + kWeak * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = -squares.ldlt().solve(sums.gradient.head<3>());
    if (!step.allFinite()) return std::nullopt;
    pose = {pose.x_m + step.x(), pose.y_m + step.y(), wrapAngle(pose.yaw_rad + step.z())};
    if (step.norm() < 1e-4 && round >= kWideRounds) break;
  }
  const Sums sums = matching.sumAt(pose, params.gate_m / 2);
  if (!agree(sums, params)) return std::nullopt;
  return quadraticOf(sums, pose, {start.calibration.offset_per_m, start.calibration.slope_per_m}, params);
}

}  // namespace cornerstone
