#include "cornerstone/registration/elastic_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace cornerstone {
namespace {

constexpr double kAtRest = 0.9;  // of the evidence there can be: nothing to gain by giving way

using Tile = std::vector<EdgeSample>;  // already carried into the grid's frame

struct Counts {
  int agree = 0;
  int contradict = 0;
  int value() const { return agree + contradict; }  // contradictions are negative
};

Counts countOn(const EvidenceGrid& grid, const Tile& tile, const Eigen::Vector2f& shift) {
  Counts counts;
  for (const EdgeSample& sample : tile) {
    const int evidence = grid.at(sample.position_m + shift, sample.direction_256);
    (evidence > 0 ? counts.agree : counts.contradict) += evidence;
  }
  return counts;
}

// The best counts of a neighbourhood within its play.
Counts settle(const EvidenceGrid& grid, const Tile& tile, const ElasticOptions& options) {
  Eigen::Vector2f at(0, 0);
  Counts best = countOn(grid, tile, at);
  if (best.value() > kAtRest * kFullEvidence * static_cast<double>(tile.size())) return best;
  auto step = static_cast<float>(options.step_m);
  for (int halving = 0; halving < 2; ++halving, step /= 2) {
    const Eigen::Vector2f centre = at;
    for (const Eigen::Vector2f& way :
         {Eigen::Vector2f(step, 0), Eigen::Vector2f(-step, 0), Eigen::Vector2f(0, step),
          Eigen::Vector2f(0, -step), Eigen::Vector2f(step, step), Eigen::Vector2f(-step, step),
          Eigen::Vector2f(step, -step), Eigen::Vector2f(-step, -step)}) {
      const Eigen::Vector2f there = centre + way;
      if (there.cwiseAbs().maxCoeff() > static_cast<float>(options.play_m)) continue;
      const Counts counts = countOn(grid, tile, there);
      if (counts.value() <= best.value()) continue;
      best = counts;
      at = there;
    }
  }
  return best;
}

PoseScore scoreOn(const EvidenceGrid& grid, const std::vector<EdgeSample>& samples,
                  const Pose2& grid_from_samples, const ElasticOptions& options) {
  const std::size_t count = std::min(samples.size(), options.max_samples);
  if (count == 0) return {};
  const Eigen::Matrix2f rotation = grid_from_samples.rotation().cast<float>();
  const Eigen::Vector2f shift = grid_from_samples.translation().cast<float>();
  const int turn = static_cast<int>(std::lround(grid_from_samples.yaw_rad * 128 / M_PI));
  std::map<std::array<int, 2>, Tile> tiles;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f square = samples[i].position_m / static_cast<float>(options.tile_m);
    tiles[{static_cast<int>(std::floor(square.y())), static_cast<int>(std::floor(square.x()))}].push_back(
        {rotation * samples[i].position_m + shift, samples[i].direction_256 + turn});
  }
  Counts sum;
  for (const auto& entry : tiles) {
    const Counts counts = settle(grid, entry.second, options);
    sum.agree += counts.agree;
    sum.contradict += counts.contradict;
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
