#include "cornerstone/registration/pose_search.h"

#include <algorithm>
#include <cmath>

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
constexpr std::size_t kFineSamples = 1000;
constexpr std::size_t kKept = 8;  // different poses in the end
constexpr double kSame_m = 0.3;   // poses this near climb to the same top
constexpr double kSame_rad = 3 * M_PI / 180;

void sortBestFirst(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.value > b.value; });
}

std::vector<Hypothesis> bestDifferent(const std::vector<Hypothesis>& sorted, const Eigen::Vector2d& middle_m,
                                      double distance_m, double angle_rad, std::size_t count) {
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : sorted) {
    if (kept.size() == count) break;
    if (std::all_of(kept.begin(), kept.end(), [&](const Hypothesis& better) {
          return areDifferent(better.reference_from_current, h.reference_from_current, middle_m, distance_m,
                              angle_rad);
        }))
      kept.push_back(h);
  }
  return kept;
}

struct Steps {
  double distance_m;
  double angle_rad;
  int halvings;
};

// Walks uphill along the axes and the yaw about the current map's middle, with shrinking steps.
struct Climb {
  const MapEvidence& reference;
  const MapEvidence& current;
  ScoreLevel level;
  std::size_t samples;
  double contradiction;

  Hypothesis from(Hypothesis best, Steps steps) const {
    for (int h = 0; h < steps.halvings; ++h) {
      for (int tries = 0; tries < 4; ++tries) {
        const Hypothesis centre = best;
        for (int axis = 0; axis < 3; ++axis) {
          for (const double sign : {-1.0, 1.0}) {
            const Hypothesis moved =
                judgePose(reference, current, step(centre.reference_from_current, axis, sign, steps), level,
                          samples, contradiction);
            if (moved.value > best.value) best = moved;
          }
        }
        if (best.value <= centre.value) break;
      }
      steps.distance_m /= 2;
      steps.angle_rad /= 2;
    }
    return best;
  }

  Pose2 step(const Pose2& pose, int axis, double sign, const Steps& steps) const {
    if (axis == 0) return {pose.x_m + sign * steps.distance_m, pose.y_m, pose.yaw_rad};
    if (axis == 1) return {pose.x_m, pose.y_m + sign * steps.distance_m, pose.yaw_rad};
    const double yaw = wrapAngle(pose.yaw_rad + sign * steps.angle_rad);
    const Eigen::Vector2d shift = pose * current.middle_m - Pose2{0, 0, yaw} * current.middle_m;
    return {shift.x(), shift.y(), yaw};
  }
};

}  // namespace

bool areDifferent(const Pose2& a, const Pose2& b, const Eigen::Vector2d& middle_m, double distance_m,
                  double angle_rad) {
  return (a * middle_m - b * middle_m).norm() > distance_m ||
         std::abs(wrapAngle(a.yaw_rad - b.yaw_rad)) > angle_rad;
}

Hypothesis judgePose(const MapEvidence& reference, const MapEvidence& current, const Pose2& pose,
                     ScoreLevel level, std::size_t max_samples, double contradiction) {
  const PoseScore score = scorePose(reference, current, pose, level, max_samples);
  return {pose, score, score.agree - contradiction * score.contradict};
}

std::vector<Hypothesis> searchPoses(const MapEvidence& reference, const MapEvidence& current,
                                    const std::vector<Pose2>& proposals, const RegistrationParams& params) {
  const auto judge = [&](const Pose2& pose, ScoreLevel level, std::size_t samples) {
    return judgePose(reference, current, pose, level, samples, params.contradiction);
  };
  const Eigen::Vector2d& middle = current.middle_m;
  std::vector<Hypothesis> poses;
  poses.reserve(proposals.size());
  for (const Pose2& pose : proposals) poses.push_back(judge(pose, ScoreLevel::kCoarse, kGlanceSamples));
  sortBestFirst(poses);
  poses.resize(std::min(poses.size(), kGlanceKept));
  for (Hypothesis& h : poses) h = judge(h.reference_from_current, ScoreLevel::kCoarse, kCoarseSamples);
  sortBestFirst(poses);
  poses = bestDifferent(poses, middle, kSame_m, kSame_rad, kCoarseKept);

  Climb climb{reference, current, ScoreLevel::kCoarse, kCoarseClimbSamples, params.contradiction};
  for (Hypothesis& h : poses) h = climb.from(h, {0.4, 4 * M_PI / 180, 3});
  poses = bestDifferent(poses, middle, kSame_m, kSame_rad, kCoarseKept);

  climb.level = ScoreLevel::kFine;
  climb.samples = kGlanceFineSamples;
  for (Hypothesis& h : poses)
    h = climb.from(judge(h.reference_from_current, ScoreLevel::kFine, climb.samples),
                   {0.2, 1 * M_PI / 180, 2});
  sortBestFirst(poses);
  poses = bestDifferent(poses, middle, kSame_m, kSame_rad, kClimbed);

  climb.samples = kFineClimbSamples;
  for (Hypothesis& h : poses) {
    const Hypothesis start = judge(h.reference_from_current, ScoreLevel::kFine, climb.samples);
    h = judge(climb.from(start, {0.1, 0.5 * M_PI / 180, 2}).reference_from_current, ScoreLevel::kFine,
              kFineSamples);
  }
  sortBestFirst(poses);
  return bestDifferent(poses, middle, params.different_m, params.different_rad, kKept);
}

}  // namespace cornerstone
