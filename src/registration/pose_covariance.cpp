#include "cornerstone/registration/pose_covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "cornerstone/base/pose2.h"

namespace cornerstone {
namespace {

using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr double kTile_m = 6;        // a room and its walls
constexpr double kLeastSlope = 0.3;  // of the loss over its weight: residuals far from normal
constexpr int kDirections = 24;      // of walls: 15 degrees take in the scatter of normals
constexpr double kGap_m = 0.2;       // in depth: more lies between two walls

// Variance of a pair's residual such that independent pairs would scatter the sums J'r of tiles as these do:
// a mean over all directions, since a scatter of few tiles is itself a chance.
double independentVariance(const FittedPairs& fitted, const Jacobian& jacobian,
                           const Eigen::VectorXd& residuals) {
  std::map<std::array<int, 2>, Eigen::Vector3d> sums;
  for (std::size_t i = 0; i < fitted.pairs.size(); ++i) {
    const Eigen::Vector2d square = fitted.pairs[i].current_m / kTile_m;
    const auto row = static_cast<Eigen::Index>(i);
    const std::array<int, 2> key{static_cast<int>(std::floor(square.y())),
                                 static_cast<int>(std::floor(square.x()))};
    sums.try_emplace(key, Eigen::Vector3d::Zero()).first->second +=
        jacobian.row(row).transpose() * residuals[row];
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& entry : sums) scatter += entry.second * entry.second.transpose();
  const auto tiles = static_cast<double>(sums.size());
  const Eigen::Matrix3d information = jacobian.transpose() * jacobian;
  // Three parameters are fitted to the tiles.
  return information.ldlt().solve(scatter).trace() / 3 * tiles / std::max(tiles - 3, 1.0);
}

// The pairs along one line.
struct Wall {
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();  // J' for a shift of the whole wall along its normal
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double first_m = 1e9, last_m = -1e9;

  void add(const LinePair& pair, const Eigen::Vector3d& row, const Eigen::Vector2d& along) {
    pull += pair.weight * row;
    normal += pair.normal;
    first_m = std::min(first_m, along.dot(pair.reference_m));
    last_m = std::max(last_m, along.dot(pair.reference_m));
  }
  // Share of a cell's variance that is left over the wall's length in a grid turned by a yaw.
  double leftOver(double yaw, double cell_m) const {
    const double angle = std::atan2(normal.y(), normal.x()) - yaw;
    const double slope = std::abs(std::tan(std::remainder(angle, M_PI / 2)));
    const double turns = (last_m - first_m) * slope / cell_m;
    return 1 / ((1 + turns) * (1 + turns));
  }
};

// A pair's place among the walls: its normal's direction, and how far along that the pair lies.
struct Place {
  int direction;
  double depth_m;
  std::size_t pair;
  bool operator<(const Place& other) const {
    return std::tie(direction, depth_m, pair) < std::tie(other.direction, other.depth_m, other.pair);
  }
};

std::array<Eigen::Vector2d, kDirections> acrossWalls() {
  std::array<Eigen::Vector2d, kDirections> across;
  for (int d = 0; d < kDirections; ++d)
    across[static_cast<std::size_t>(d)] = Pose2{0, 0, d * 2 * M_PI / kDirections} * Eigen::Vector2d(1, 0);
  return across;
}

// Pairs of one direction without a gap in depth.
std::vector<Wall> wallsOf(const FittedPairs& fitted, const Jacobian& jacobian) {
  const std::array<Eigen::Vector2d, kDirections> across_walls = acrossWalls();
  std::vector<Place> places;
  places.reserve(fitted.pairs.size());
  for (std::size_t i = 0; i < fitted.pairs.size(); ++i) {
    const LinePair& pair = fitted.pairs[i];
    const double turns = std::atan2(pair.normal.y(), pair.normal.x()) / (2 * M_PI);
    const int direction = (static_cast<int>(std::lround(turns * kDirections)) + kDirections) % kDirections;
    places.push_back({direction, across_walls[static_cast<std::size_t>(direction)].dot(pair.reference_m), i});
  }
  std::sort(places.begin(), places.end());
  std::vector<Wall> walls;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || places[i].direction != places[i - 1].direction ||
        places[i].depth_m > places[i - 1].depth_m + kGap_m)
      walls.emplace_back();
    const Eigen::Vector2d& across = across_walls[static_cast<std::size_t>(places[i].direction)];
    walls.back().add(fitted.pairs[places[i].pair],
                     jacobian.row(static_cast<Eigen::Index>(places[i].pair)).transpose(),
                     Eigen::Vector2d(-across.y(), across.x()));
  }
  return walls;
}

Eigen::Matrix3d scatterOfCells(const FittedPairs& fitted, const Jacobian& jacobian) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  const double variance_m2 = fitted.cell_m * fitted.cell_m / 12;  // of a place anywhere in a cell
  for (const Wall& wall : wallsOf(fitted, jacobian))
    scatter += variance_m2 * (wall.leftOver(0, fitted.cell_m) + wall.leftOver(fitted.x[2], fitted.cell_m)) *
               wall.pull * wall.pull.transpose();
  return scatter;
}

}  // namespace

FitQuality judgeFit(const FittedPairs& fitted) {
  const auto count = static_cast<Eigen::Index>(fitted.pairs.size());
  Eigen::VectorXd residuals(count);
  Jacobian jacobian(count, 3);
  const double* block = fitted.x.data();
  double* jacobians[] = {jacobian.data()};
  LineCost(fitted.pairs).Evaluate(&block, residuals.data(), jacobians);
  FitQuality quality;
  double weights = 0, slopes = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double squared =
        fitted.pairs[static_cast<std::size_t>(i)].weight * fitted.pairs[static_cast<std::size_t>(i)].weight;
    const double u2 = residuals[i] * residuals[i] / (squared * fitted.scale_m * fitted.scale_m);
    weights += squared;
    slopes += squared * (1 - u2) / (1 + u2);  // the second derivative of the Cauchy loss
  }
  quality.rms_m = std::sqrt(residuals.squaredNorm() / weights);
  const Eigen::Matrix3d information = jacobian.transpose() * jacobian;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(information.topLeftCorner<2, 2>());
  quality.spread = axes.eigenvalues()[0] / axes.eigenvalues()[1];
  const double slope = std::max(slopes / weights, kLeastSlope);
  const Eigen::Matrix3d inverse = information.inverse();
  // Both maps' edges see the same walls, so each pair counts half.
  const double variance_m2 =
      2 * quality.rms_m * quality.rms_m + independentVariance(fitted, jacobian, residuals) / (slope * slope);
  quality.covariance = variance_m2 * inverse + inverse * scatterOfCells(fitted, jacobian) * inverse;
  return quality;
}

}  // namespace cornerstone
