#include "cornerstone/landmarks/surface_corners.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

namespace cornerstone {
namespace {

constexpr double kClear_m = 0.05;     // points so near the apex may be of either arm
constexpr double kAcross_m = 0.08;    // from an arm: what a drawn corner is off by, less than a thin wall
constexpr double kLoss_m = 0.01;      // residuals beyond count less (Cauchy): plaster, frames, the other face
constexpr double kFloor_m = 0.005;    // what no number of looks averages away in one cell
constexpr double kFarthest_m = 0.15;  // a corner that moves more is another one
constexpr double kFarthest_rad = 15 * M_PI / 180;
constexpr int kRounds = 5;
constexpr std::size_t kBins = 5;       // of an arm's length,
constexpr std::size_t kLeastBins = 3;  // of which so many must hold surface

struct Fit {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  std::array<std::bitset<kBins>, 2> covered;

  bool isCovered() const { return std::min(covered[0].count(), covered[1].count()) >= kLeastBins; }
};

}  // namespace

SurfaceCorners::SurfaceCorners(std::vector<SurfacePoint> surface, double arm_length_m)
    : surface_(std::move(surface)), arm_length_m_(arm_length_m) {
  std::sort(surface_.begin(), surface_.end(),
            [](const SurfacePoint& a, const SurfacePoint& b) { return a.x_m < b.x_m; });
}

CornerLandmark SurfaceCorners::settled(const CornerLandmark& corner) const {
  const auto x_m = static_cast<float>(corner.pose.x_m);
  const auto around_m = static_cast<float>(arm_length_m_ + kAcross_m + kFarthest_m);
  const auto isLeft = [](const SurfacePoint& point, float limit_m) { return point.x_m < limit_m; };
  const auto first = std::lower_bound(surface_.begin(), surface_.end(), x_m - around_m, isLeft);
  const auto last = std::lower_bound(first, surface_.end(), x_m + around_m, isLeft);
  Pose2 pose = corner.pose;
  Fit fit;
  for (int round = 0; round < kRounds; ++round) {
    fit = {};
    const Eigen::Matrix2d rotation = pose.rotation();
    for (auto point = first; point != last; ++point) {
      const Eigen::Vector2d p = rotation.transpose() * (point->position_m() - pose.translation());
      const int arm = p.x() >= p.y() ? 0 : 1;  // arm 0 along +x, its distance is p.y; arm 1 along +y
      const double along = p[arm], away = p[1 - arm];
      if (along < kClear_m || along >= arm_length_m_ || std::abs(away) > kAcross_m) continue;
      const Eigen::Vector2d axis = rotation.col(1 - arm);
      const Eigen::Vector3d row(-axis.x(), -axis.y(), arm == 0 ? -along : along);
      const double variance_m2 = 1 / static_cast<double>(point->weight) + kFloor_m * kFloor_m;
      const double weight = 1 / (variance_m2 * (1 + away * away / (kLoss_m * kLoss_m)));
      fit.information += weight * row * row.transpose();
      fit.gradient += weight * away * row;
      fit.covered[static_cast<std::size_t>(arm)].set(
          static_cast<std::size_t>(along / arm_length_m_ * static_cast<double>(kBins)));
    }
    if (!fit.isCovered()) return corner;
    const Eigen::Vector3d step = fit.information.ldlt().solve(-fit.gradient);
    pose = {pose.x_m + step[0], pose.y_m + step[1], wrapAngle(pose.yaw_rad + step[2])};
    const Pose2 moved = corner.pose.inverse() * pose;
    if (!pose.isFinite() || moved.translation().norm() > kFarthest_m ||
        std::abs(moved.yaw_rad) > kFarthest_rad)
      return corner;
  }
  CornerLandmark settled = corner;
  settled.pose = pose;
  settled.covariance = fit.information.inverse();
  return settled;
}

}  // namespace cornerstone
