#include "cornerstone/registration/proposals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cornerstone/landmarks/edge_index.h"

namespace cornerstone {
namespace {

constexpr int kDegrees = 360;
constexpr double kWallReach_m = 0.5;
constexpr double kWallDepth_m = 0.15;  // edges this far beside are another wall's
constexpr double kSameWallCosine = 0.8;
constexpr std::size_t kMaxWallEdges = 800;  // directions of so many edges make a smooth histogram
constexpr std::size_t kMaxCorners = 60;  // the best fitted of each map: maps with more share plenty of them
constexpr double kLowPeak = 0.25;        // of the highest: so few walls as agree there are chance
constexpr double kYawReach_rad = 8 * M_PI / 180;  // a corner's arms of ten cells are right to some 5 degrees

// The direction of the wall around an edge: over a metre the cells' staircase no longer matters. Empty: no
// line.
std::optional<double> wallDirection(const EdgeIndex& index, const EdgePoint& edge) {
  double count = 0;
  Eigen::Vector2d sum(0, 0);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  index.forEachNear(edge.position_m, kWallReach_m, [&](const EdgePoint& other) {
    const Eigen::Vector2d offset = other.position_m - edge.position_m;
    if (offset.squaredNorm() > kWallReach_m * kWallReach_m ||
        std::abs(offset.dot(edge.normal)) > kWallDepth_m || other.normal.dot(edge.normal) < kSameWallCosine)
      return;
    ++count;
    sum += offset;
    squares += offset * offset.transpose();
  });
  if (count < 5) return std::nullopt;
  const Eigen::Vector2d mean = sum / count;
  const Eigen::Matrix2d spread = squares / count - mean * mean.transpose();
  if (spread.trace() < kWallReach_m * kWallReach_m / 12) return std::nullopt;  // too short
  const double line = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
  const Eigen::Vector2d normal(-std::sin(line), std::cos(line));
  return normal.dot(edge.normal) > 0 ? line + M_PI / 2 : line - M_PI / 2;
}

}  // namespace

std::vector<double> wallDirections(const std::vector<EdgePoint>& edges) {
  const EdgeIndex index(edges, 0.5 * kWallReach_m);
  std::vector<double> sharp(kDegrees), smooth(kDegrees);
  for (std::size_t i = 0; i < std::min(edges.size(), kMaxWallEdges); ++i) {
    const auto direction = wallDirection(index, edges[i]);
    if (!direction) continue;
    const double degrees = *direction * 180 / M_PI + 2 * kDegrees;
    const auto low = static_cast<std::size_t>(degrees);
    const double share = degrees - static_cast<double>(low);
    sharp[low % kDegrees] += 1 - share;
    sharp[(low + 1) % kDegrees] += share;
  }
  constexpr std::array<double, 5> kernel{1, 4, 6, 4, 1};  // a degree wide
  for (int i = 0; i < kDegrees; ++i)
    for (int k = 0; k < 5; ++k)
      smooth[static_cast<std::size_t>(i)] +=
          kernel[static_cast<std::size_t>(k)] *
          sharp[static_cast<std::size_t>((i + k - 2 + kDegrees) % kDegrees)];
  return smooth;
}

DirectionMatch::DirectionMatch(const std::vector<double>& reference, const std::vector<double>& current)
    : agreement_(kDegrees) {
  for (int turn = 0; turn < kDegrees; ++turn)
    for (int i = 0; i < kDegrees; ++i)
      agreement_[static_cast<std::size_t>(turn)] +=
          reference[static_cast<std::size_t>((i + turn) % kDegrees)] * current[static_cast<std::size_t>(i)];
}

double DirectionMatch::nearestPeak(double yaw_rad, double reach_rad) const {
  const int middle = static_cast<int>(std::lround(yaw_rad * 180 / M_PI)) + 2 * kDegrees;
  const int reach = static_cast<int>(reach_rad * 180 / M_PI);
  int best = middle;
  for (int turn = middle - reach; turn <= middle + reach; ++turn)
    if (agreement_[static_cast<std::size_t>(turn % kDegrees)] >
        agreement_[static_cast<std::size_t>(best % kDegrees)])
      best = turn;
  if (std::abs(best - middle) == reach) return yaw_rad;  // on a slope: no peak here
  const double left = agreement_[static_cast<std::size_t>((best + kDegrees - 1) % kDegrees)];
  const double at = agreement_[static_cast<std::size_t>(best % kDegrees)];
  const double right = agreement_[static_cast<std::size_t>((best + 1) % kDegrees)];
  const double bend = left - 2 * at + right;
  const double shift = bend < 0 ? 0.5 * (left - right) / bend : 0;
  return wrapAngle((best + std::clamp(shift, -0.5, 0.5)) * M_PI / 180);
}

std::vector<double> DirectionMatch::peaks(std::size_t count) const {
  std::vector<int> found;
  for (int i = 0; i < kDegrees; ++i) {
    bool highest = true;
    for (int k = -5; k <= 5 && highest; ++k)
      highest = agreement_[static_cast<std::size_t>((i + k + kDegrees) % kDegrees)] <=
                agreement_[static_cast<std::size_t>(i)];
    if (highest && agreement_[static_cast<std::size_t>(i)] > 0) found.push_back(i);
  }
  std::stable_sort(found.begin(), found.end(), [&](int a, int b) {
    return agreement_[static_cast<std::size_t>(a)] > agreement_[static_cast<std::size_t>(b)];
  });
  found.resize(std::min(found.size(), count));
  while (!found.empty() && agreement_[static_cast<std::size_t>(found.back())] <
                               kLowPeak * agreement_[static_cast<std::size_t>(found.front())])
    found.pop_back();
  std::vector<double> yaws;
  for (const int turn : found) yaws.push_back(nearestPeak(turn * M_PI / 180, 5 * M_PI / 180));
  return yaws;
}

std::vector<Pose2> proposeFromCorners(const std::vector<CornerLandmark>& reference,
                                      const std::vector<CornerLandmark>& current,
                                      const DirectionMatch& directions) {
  std::vector<Pose2> poses;
  for (std::size_t r = 0; r < std::min(reference.size(), kMaxCorners); ++r) {
    for (std::size_t c = 0; c < std::min(current.size(), kMaxCorners); ++c) {
      const CornerLandmark& there = reference[r];
      const CornerLandmark& here = current[c];
      if (there.kind != here.kind) continue;
      const double yaw =
          directions.nearestPeak(wrapAngle(there.pose.yaw_rad - here.pose.yaw_rad), kYawReach_rad);
      const Eigen::Vector2d shift = there.pose.translation() - Pose2{0, 0, yaw} * here.pose.translation();
      poses.push_back({shift.x(), shift.y(), yaw});
    }
  }
  return poses;
}

std::vector<Pose2> mergeProposals(const std::vector<Pose2>& poses, const Eigen::Vector2d& middle_m,
                                  double square_m, double angle_rad) {
  using Key = std::array<int, 3>;
  std::vector<std::pair<Key, std::size_t>> keyed;
  keyed.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector2d at = poses[i] * middle_m / square_m;
    keyed.push_back({{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                      static_cast<int>(std::floor(poses[i].yaw_rad / angle_rad))},
                     i});
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<Pose2> merged;
  for (std::size_t i = 0; i < keyed.size(); ++i)
    if (i == 0 || keyed[i].first != keyed[i - 1].first) merged.push_back(poses[keyed[i].second]);
  return merged;
}

}  // namespace cornerstone
