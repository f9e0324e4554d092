#include "cornerstone/registration/pose_score.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cornerstone {

PoseScore scoreSamples(const EvidenceGrid& grid, const EdgeSamples& samples, const Pose2& grid_from_samples,
                       std::size_t max_samples) {
  const std::size_t count = std::min(samples.size(), max_samples);
  if (count == 0) return {};
  const Eigen::Matrix2f rotation = grid.squaresPerMetre() * grid_from_samples.rotation().cast<float>();
  const Eigen::Vector2f shift =
      grid.squaresPerMetre() * (grid_from_samples.translation().cast<float>() - grid.origin());
  const float c = rotation(0, 0), s = rotation(1, 0), x = shift.x(), y = shift.y();
  const int turn = static_cast<int>(std::lround(grid_from_samples.yaw_rad * 128 / M_PI));
  const EvidenceSum sum = grid.sum(samples, count, turn, [&](float px, float py) {
    return std::pair(c * px - s * py + x, s * px + c * py + y);
  });
  const double scale = static_cast<double>(samples.size()) / (static_cast<double>(count) * kFullEvidence);
  return {sum.agree * scale, -sum.contradict * scale};
}

PoseScore scorePose(const EvidencePair& maps, const Pose2& reference_from_current, const Look& look) {
  const auto& [there, here] = maps;
  const bool coarse = look.level == ScoreLevel::kCoarse;
  const PoseScore one = scoreSamples(coarse ? there.coarse : there.fine, here.samples, reference_from_current,
                                     look.max_samples);
  const PoseScore other = scoreSamples(coarse ? here.coarse : here.fine, there.samples,
                                       reference_from_current.inverse(), look.max_samples);
  return {0.5 * (one.agree + other.agree), 0.5 * (one.contradict + other.contradict)};
}

}  // namespace cornerstone
