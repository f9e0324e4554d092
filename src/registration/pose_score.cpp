#include "cornerstone/registration/pose_score.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

// The edges of one map on the grid of another.
PoseScore scoreOn(const EvidenceGrid& grid, const std::vector<EdgeSample>& samples,
                  const Pose2& grid_from_samples, std::size_t max_samples) {
  const std::size_t count = std::min(samples.size(), max_samples);
  if (count == 0) return {};
  const Eigen::Matrix2f rotation = grid_from_samples.rotation().cast<float>();
  const Eigen::Vector2f shift = grid_from_samples.translation().cast<float>();
  const int turn = static_cast<int>(std::lround(grid_from_samples.yaw_rad * 128 / M_PI));
  int agree = 0, contradict = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int evidence = grid.at(rotation * samples[i].position_m + shift, samples[i].direction_256 + turn);
    (evidence > 0 ? agree : contradict) += evidence;
  }
  const double scale = static_cast<double>(samples.size()) / (static_cast<double>(count) * kFullEvidence);
  return {agree * scale, -contradict * scale};
}

}  // namespace

PoseScore scorePose(const MapEvidence& reference, const MapEvidence& current,
                    const Pose2& reference_from_current, ScoreLevel level, std::size_t max_samples) {
  const bool coarse = level == ScoreLevel::kCoarse;
  const PoseScore one = scoreOn(coarse ? reference.coarse : reference.fine, current.samples,
                                reference_from_current, max_samples);
  const PoseScore other = scoreOn(coarse ? current.coarse : current.fine, reference.samples,
                                  reference_from_current.inverse(), max_samples);
  return {0.5 * (one.agree + other.agree), 0.5 * (one.contradict + other.contradict)};
}

}  // namespace cornerstone
