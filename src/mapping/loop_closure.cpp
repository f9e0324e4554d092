#include "cornerstone/mapping/loop_closure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr std::size_t kFramesOfThen = 60;  // spread over those within reach: drawing them is most of a search
// Of the newest looks' ends, for the map of then to bear out where the robot has itself.
constexpr double kKnownHere = 0.1;
// Of single frames of then and now: each may be a chance, true loops have had 20 to 500.
constexpr std::size_t kLeastMatches = 10;
// Of the bent way's end from where the newest looks were found: the matches decide, in their own accuracy.
constexpr double kLeft_m = 0.3, kLeft_rad = 2 * M_PI / 180;

double stepLength(const std::vector<KeyFrame>& frames, std::size_t later) {
  return (frames[later].map_from_base.translation() - frames[later - 1].map_from_base.translation()).norm();
}

// The last frame from which at least `way_m` lead to frame `to`.
std::size_t frameBefore(const std::vector<KeyFrame>& frames, std::size_t to, double way_m) {
  while (to > 0 && way_m > 0) way_m -= stepLength(frames, to--);
  return to;
}

// Of the first `end` frames those that the robot may stand near by now.
std::vector<std::size_t> framesNear(const std::vector<KeyFrame>& frames, std::size_t end, double reach_m) {
  const Eigen::Vector2d at_m = frames.back().map_from_base.translation();
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < end; ++i)
    if ((frames[i].map_from_base.translation() - at_m).norm() < reach_m) near.push_back(i);
  return near;
}

RangeScan lookOf(const KeyFrame& frame, const ScanCalibration& calibration) {
  return corrected(*frame.looks.front().scan, calibration);
}

OccupancyGrid mapOf(const std::vector<IndexedFrame>& frames, const LoopSearchParams& params) {
  OccupancyGrid map(params.grid);
  for (const IndexedFrame& then : frames)
    map.insert(lookOf(then.frame, params.calibration), then.frame.map_from_base);
  return map;
}

// The looks as the last one's base would see them together. Its bearings do not rise: the beams of each look
// stay side by side, as a scan fit wants them.
RangeScan wideLook(const std::vector<IndexedFrame>& frames, const ScanCalibration& calibration) {
  RangeScan wide;
  const Pose2 base_from_map = frames.back().frame.map_from_base.inverse();
  for (const IndexedFrame& now : frames) {
    const RangeScan look = lookOf(now.frame, calibration);
    const Pose2 base_from_sensor = base_from_map * now.frame.map_from_base * look.base_from_sensor;
    wide.correlated_beams = std::max(wide.correlated_beams, look.correlated_beams);
    for (Beam beam : look.beams) {
      if (!beam.hit) continue;
      const Eigen::Vector2d ray(std::cos(beam.bearing_rad), std::sin(beam.bearing_rad));
      const Eigen::Vector2d end_m = base_from_sensor * (beam.range_m * ray);
      beam.bearing_rad = std::atan2(end_m.y(), end_m.x());
      beam.range_m = end_m.norm();
      wide.beams.push_back(beam);
    }
  }
  return wide;
}

// `correction` moves the frames of now to where they were found.
std::vector<GraphMatch> matchesOf(const OpenLoop& loop, const Pose2& correction,
                                  const LoopSearchParams& params) {
  std::vector<GraphMatch> matches;
  for (const IndexedFrame& then : loop.then) {
    for (const IndexedFrame& now : loop.now) {
      const Pose2 moved = correction * now.frame.map_from_base;
      if (!mayMatch(then.frame.map_from_base, moved, params.graph)) continue;
      const FrameMatchStart start{then.frame.map_from_base.inverse() * moved, params.calibration};
      const auto match = matchFrames(then.frame, now.frame, start, params.graph.match);
      if (match) matches.push_back({then.index, now.index, *match});
    }
  }
  return matches;
}

GraphProblem startedAt(GraphProblem problem, const GraphSolution& solution) {
  problem.map_from_base = solution.map_from_base;
  problem.rates = solution.rates;
  problem.calibration = solution.calibration;
  return problem;
}

// At first the new matches count in full, however far off they are; then as all others.
std::optional<GraphSolution> bend(const GraphProblem& problem, const std::vector<GraphMatch>& matches) {
  GraphProblem closed = problem;
  closed.matches.insert(closed.matches.end(), matches.begin(), matches.end());
  closed.held_matches = matches.size();
  const std::optional<GraphSolution> forced = solve(closed);
  if (!forced) return std::nullopt;
  closed.held_matches = 0;
  std::optional<GraphSolution> bent = solve(startedAt(closed, *forced));
  if (bent) bent->loop = matches;
  return bent;
}

// What the bent way asks of all that was known before, against the way that fits it best.
double strainOf(const GraphProblem& problem, const GraphSolution& bent) {
  const std::optional<GraphSolution> unbent = solve(problem);
  if (!unbent) return std::numeric_limits<double>::infinity();
  const double gain = costOf(startedAt(problem, bent)) - costOf(startedAt(problem, *unbent));
  return std::sqrt(std::max(0.0, 2 * gain));
}

bool liesAsFound(const GraphSolution& bent, const FoundLoop& loop) {
  const Pose2 then_from_now = bent.map_from_base[loop.then].inverse() * bent.map_from_base[loop.now];
  const Pose2 left = loop.then_from_now.inverse() * then_from_now;
  return left.translation().norm() < kLeft_m && std::abs(left.yaw_rad) < kLeft_rad;
}

}  // namespace

void describe(ParamVisitor& visitor, LoopParams& params) {
  visitor.field("reach_m", params.reach_m);
  visitor.degrees("reach_deg", params.reach_rad);
  visitor.field("max_drift_ratio", params.max_drift_ratio);
  visitor.field("min_way_m", params.min_way_m);
  visitor.field("look_way_m", params.look_way_m);
  visitor.field("min_known_share", params.min_known_share);
  visitor.field("max_strain_sigmas", params.max_strain_sigmas);
}

void requireValid(const LoopParams& params) {
  requireWithin(params.reach_m, 0, 20, "reach_m");
  requireWithin(params.reach_rad, 0, 3.2, "reach_deg");
  requireWithin(params.max_drift_ratio, 0, 1, "max_drift_ratio");
  requireWithin(params.min_way_m, 1, 1e6, "min_way_m");
  requireWithin(params.look_way_m, 0, 100, "look_way_m");
  requireWithin(params.min_known_share, 0.1, 1, "min_known_share");
  requireWithin(params.max_strain_sigmas, 0, 1e6, "max_strain_sigmas");
}

std::optional<OpenLoop> openLoop(const FrameGraph& graph, std::size_t sure, const LoopParams& params) {
  const std::vector<KeyFrame>& frames = graph.frames();
  if (!(params.reach_m > 0) || frames.empty()) return std::nullopt;
  const std::size_t now_begin = frameBefore(frames, frames.size() - 1, params.look_way_m);
  const std::size_t then_end = frameBefore(frames, now_begin, params.min_way_m);
  const std::vector<std::size_t> near =
      framesNear(frames, then_end, params.reach_m + graph.params().match_distance_m);
  if (near.empty()) return std::nullopt;
  OpenLoop loop;
  const std::size_t count = std::min(near.size(), kFramesOfThen);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = near[(i + 1) * near.size() / count - 1];  // the newest among them
    loop.then.push_back({index, frames[index]});
  }
  for (std::size_t i = now_begin; i < frames.size(); ++i) loop.now.push_back({i, frames[i]});
  for (std::size_t i = std::max(near.back(), sure) + 1; i < frames.size(); ++i)
    loop.way_m += stepLength(frames, i);
  return loop;
}

LoopSearch findLoop(const OpenLoop& loop, const LoopSearchParams& params) {
  const IndexedFrame& then = loop.then.back();
  const IndexedFrame& now = loop.now.back();
  const OccupancyGrid map = mapOf(loop.then, params);
  SearchWindow window;
  window.map_from_base = now.frame.map_from_base;
  window.reach_m = std::min(params.loop.reach_m, params.loop.max_drift_ratio * loop.way_m);
  window.reach_rad = params.loop.reach_rad;
  window.min_known_share = params.loop.min_known_share;
  window.min_known_share_here = kKnownHere;
  const Relocalisation found =
      relocalise({wideLook(loop.now, params.calibration), map}, window, params.fit, params.place);
  LoopSearch search{now.index, found.here, std::nullopt};
  if (!found.pose) return search;
  const Pose2& map_from_now = found.pose->map_from_base;
  FoundLoop closed;
  closed.matches = matchesOf(loop, map_from_now * now.frame.map_from_base.inverse(), params);
  if (closed.matches.size() < kLeastMatches) return search;
  closed.then = then.index;
  closed.now = now.index;
  closed.then_from_now = then.frame.map_from_base.inverse() * map_from_now;
  search.found = std::move(closed);
  return search;
}

std::optional<GraphSolution> closeLoop(const GraphProblem& problem, const FoundLoop& loop,
                                       double max_strain_sigmas) {
  std::optional<GraphSolution> bent = bend(problem, loop.matches);
  if (!bent || !liesAsFound(*bent, loop) || strainOf(problem, *bent) > max_strain_sigmas) return std::nullopt;
  return bent;
}

}  // namespace cornerstone
