#include "cornerstone/registration/pose_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <utility>

namespace cornerstone {
namespace {

// Edges of each map that judge a pose, and how many poses go on to the next judgement.
constexpr std::size_t kGlanceSamples = 50;
constexpr std::size_t kGlanceKept = 400;
constexpr std::size_t kCoarseSamples = 200;  // scores scatter by a few per cent
constexpr std::size_t kCoarseKept = 60;
constexpr std::size_t kClimbed = 20;
constexpr std::size_t kCoarseClimbSamples = 120;
constexpr std::size_t kGlanceFineSamples = 150;
constexpr std::size_t kFineClimbSamples = 300;
constexpr std::size_t kFineSamples = 3000;
constexpr int kTries = 4;          // at each size of step
constexpr std::size_t kKept = 8;   // different poses in the end
constexpr double kHopeless = 0.2;  // of the best value so far: no rival comes from there
constexpr double kSame_m = 0.3;    // poses this near climb to the same top
constexpr double kSame_rad = 3 * M_PI / 180;

void sortBestFirst(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.value > b.value; });
}

// The best ones, each apart from every better one.
std::vector<Hypothesis> bestApart(const std::vector<Hypothesis>& sorted, const PoseDistance& distance,
                                  std::size_t count) {
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : sorted) {
    if (kept.size() == count) break;
    if (std::all_of(kept.begin(), kept.end(), [&](const Hypothesis& better) {
          return distance.apart(better.reference_from_current, h.reference_from_current);
        }))
      kept.push_back(h);
  }
  return kept;
}

// What a pose is worth at a look.
struct Judge {
  const EvidencePair& maps;
  const RegistrationParams& params;

  Hypothesis operator()(const Pose2& pose, const Look& look) const {
    const PoseScore score = scorePose(maps, pose, look);
    const double weight =
        look.level == ScoreLevel::kCoarse ? params.coarse_contradiction : params.contradiction;
    return {pose, score, score.agree - weight * score.contradict};
  }
};

struct Steps {
  double distance_m;
  double angle_rad;
  int halvings;
};

// Walks uphill along the axes and the yaw about the current map's middle, with shrinking steps.
struct Climb {
  const Judge& judge;
  Look look;
  Steps steps;

  Hypothesis from(const Pose2& start) const {
    Hypothesis best = judge(start, look);
    Steps now = steps;
    for (int h = 0; h < steps.halvings; ++h) {
      int back = -1;  // the way back to the centre before, which was worse
      for (int tries = 0; tries < kTries; ++tries) {
        const Hypothesis centre = best;
        int taken = -1;
        for (int way = 0; way < 6; ++way) {
          if (way == back) continue;
          const Hypothesis moved = judge(step(centre.reference_from_current, way, now), look);
          if (moved.value <= best.value) continue;
          best = moved;
          taken = way;
        }
        if (taken < 0) break;
        back = taken ^ 1;
      }
      now.distance_m /= 2;
      now.angle_rad /= 2;
    }
    return best;
  }

  // way: along x, y and the yaw, of each first back, then forth.
  Pose2 step(const Pose2& pose, int way, const Steps& now) const {
    const int axis = way / 2;
    const double sign = way % 2 == 0 ? -1 : 1;
    if (axis == 0) return {pose.x_m + sign * now.distance_m, pose.y_m, pose.yaw_rad};
    if (axis == 1) return {pose.x_m, pose.y_m + sign * now.distance_m, pose.yaw_rad};
    const double yaw = wrapAngle(pose.yaw_rad + sign * now.angle_rad);
    const Eigen::Vector2d& middle = judge.maps.current.middle_m;
    const Eigen::Vector2d shift = pose * middle - Pose2{0, 0, yaw} * middle;
    return {shift.x(), shift.y(), yaw};
  }
};

// Poses are judged one by one: each processor takes some of them.
template <typename JudgePose>
void judgeEach(std::vector<Hypothesis>& poses, const JudgePose& judge) {
  cv::parallel_for_(cv::Range(0, static_cast<int>(poses.size())), [&](const cv::Range& range) {
    for (auto i = static_cast<std::size_t>(range.start); i < static_cast<std::size_t>(range.end); ++i)
      poses[i] = judge(poses[i].reference_from_current);
  });
}

}  // namespace

bool PoseDistance::apart(const Pose2& a, const Pose2& b) const {
  return (a * point_in_current_m - b * point_in_current_m).squaredNorm() > distance_m * distance_m ||
         std::abs(wrapAngle(a.yaw_rad - b.yaw_rad)) > angle_rad;
}

void settlePoses(const EvidencePair& maps, std::vector<Hypothesis>& poses, const RegistrationParams& params) {
  const Judge judge{maps, params};
  const Climb climb{judge, {ScoreLevel::kFine, kFineClimbSamples}, {0.1, M_PI / 180, 4}};
  judgeEach(poses, [&](const Pose2& pose) {
    return judge(climb.from(pose).reference_from_current, {ScoreLevel::kFine, kFineSamples});
  });
}

std::vector<Hypothesis> searchPoses(const EvidencePair& maps, const std::vector<Pose2>& proposals,
                                    const RegistrationParams& params) {
  const Judge judge{maps, params};
  const PoseDistance same{maps.current.middle_m, kSame_m, kSame_rad};
  const auto judgeAt = [&](const Look& look) {
    return [&judge, look](const Pose2& pose) { return judge(pose, look); };
  };
  std::vector<Hypothesis> poses;
  poses.reserve(proposals.size());
  for (const Pose2& pose : proposals) poses.push_back({pose, {}, 0});
  judgeEach(poses, judgeAt({ScoreLevel::kCoarse, kGlanceSamples}));
  sortBestFirst(poses);
  poses.resize(std::min(poses.size(), kGlanceKept));
  judgeEach(poses, judgeAt({ScoreLevel::kCoarse, kCoarseSamples}));
  sortBestFirst(poses);
  poses = bestApart(poses, same, kCoarseKept);

  const auto rounds = {
      std::pair(Climb{judge, {ScoreLevel::kCoarse, kCoarseClimbSamples}, {0.4, 4 * M_PI / 180, 3}},
                kCoarseKept),
      std::pair(Climb{judge, {ScoreLevel::kFine, kGlanceFineSamples}, {0.2, M_PI / 180, 2}}, kClimbed),
      std::pair(Climb{judge, {ScoreLevel::kFine, kFineClimbSamples}, {0.1, 0.5 * M_PI / 180, 3}}, kClimbed)};
  for (const auto& round : rounds) {
    judgeEach(poses, [&](const Pose2& pose) { return round.first.from(pose); });
    sortBestFirst(poses);
    while (!poses.empty() && poses.back().value < kHopeless * poses.front().value) poses.pop_back();
    poses = bestApart(poses, same, round.second);
  }
  judgeEach(poses, judgeAt({ScoreLevel::kFine, kFineSamples}));
  sortBestFirst(poses);
  return bestApart(poses, {maps.current.middle_m, params.different_m, params.different_rad}, kKept);
}

}  // namespace cornerstone
