#include "cornerstone/registration/elastic_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace cornerstone {
namespace {

constexpr double kAtRest = 0.9;  // of the evidence there can be: nothing to gain by giving way

using Tile = EdgeSamples;  // already carried into the grid's frame

EvidenceSum sumOn(const EvidenceGrid& grid, const Tile& tile, const Eigen::Vector2f& shift) {
  const float x = shift.x(), y = shift.y(), per_metre = grid.squaresPerMetre();
  const float left = grid.origin().x(), bottom = grid.origin().y();
  return grid.sum(tile, tile.size(), 0, [=](float px, float py) {
    return std::pair((px + x - left) * per_metre, (py + y - bottom) * per_metre);
  });
}

// The best sum of a neighbourhood within its play.
EvidenceSum settle(const EvidenceGrid& grid, const Tile& tile, const ElasticOptions& options) {
  Eigen::Vector2f at(0, 0);
  EvidenceSum best = sumOn(grid, tile, at);
  if (best.both() > kAtRest * kFullEvidence * static_cast<double>(tile.size())) return best;
  auto step = static_cast<float>(options.step_m);
  for (int halving = 0; halving < 2; ++halving, step /= 2) {
    const Eigen::Vector2f centre = at;
    for (const Eigen::Vector2f& way :
         {Eigen::Vector2f(step, 0), Eigen::Vector2f(-step, 0), Eigen::Vector2f(0, step),
          Eigen::Vector2f(0, -step), Eigen::Vector2f(step, step), Eigen::Vector2f(-step, step),
          Eigen::Vector2f(step, -step), Eigen::Vector2f(-step, -step)}) {
      const Eigen::Vector2f there = centre + way;
      if (there.cwiseAbs().maxCoeff() > static_cast<float>(options.play_m)) continue;
      const EvidenceSum sum = sumOn(grid, tile, there);
      if (sum.both() <= best.both()) continue;
      best = sum;
      at = there;
    }
  }
  return best;
}

PoseScore scoreOn(const EvidenceGrid& grid, const EdgeSamples& samples, const Pose2& grid_from_samples,
                  const ElasticOptions& options) {
  const std::size_t count = std::min(samples.size(), options.max_samples);
  if (count == 0) return {};
  const Eigen::Matrix2f rotation = grid_from_samples.rotation().cast<float>();
  const Eigen::Vector2f shift = grid_from_samples.translation().cast<float>();
  const int turn = static_cast<int>(std::lround(grid_from_samples.yaw_rad * 128 / M_PI));
  std::map<std::array<int, 2>, Tile> tiles;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f at = samples.position_m(i), square = at / static_cast<float>(options.tile_m);
    tiles[{static_cast<int>(std::floor(square.y())), static_cast<int>(std::floor(square.x()))}].add(
        rotation * at + shift, samples.direction_256[i] + turn);
  }
  EvidenceSum sum;
  for (const auto& entry : tiles) {
    const EvidenceSum of_tile = settle(grid, entry.second, options);
    sum.agree += of_tile.agree;
    sum.contradict += of_tile.contradict;
  }
  const double scale = static_cast<double>(samples.size()) / (static_cast<double>(count) * kFullEvidence);
  return {sum.agree * scale, -sum.contradict * scale};
}

}  // namespace

PoseScore scoreElastic(const MapEvidence& reference, const MapEvidence& current,
                       const Pose2& reference_from_current, const ElasticOptions& options) {
  const PoseScore one = scoreOn(reference.fine, current.samples, reference_from_current, options);
  const PoseScore other = scoreOn(current.fine, reference.samples, reference_from_current.inverse(), options);
  return {0.5 * (one.agree + other.agree), 0.5 * (one.contradict + other.contradict)};
}

}  // namespace cornerstone
