#include "tools/run_metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kNear_m = 0.10;    // two cells: within it a cell and a surface count as the same
constexpr float kOccupied = 0.65f;  // map_server's occupied_thresh
constexpr double kTruthStep_s =
    0.2;  // between the poses from which "seen" is judged; 5 Hz as the paper's cameras
constexpr double kTfStep_s = 0.1;

// World points of a map's occupied cells.
std::vector<Eigen::Vector2d> occupiedPoints(const GridMap& map, const Pose2& world_from_map) {
  std::vector<Eigen::Vector2d> points;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col)
      if (map.occupied(row, col) > kOccupied)
        points.push_back(world_from_map * map.geometry.centreOf({col, row}));
  return points;
}

// Of the given surface points, how many lie within kNear_m of one of `points`.
std::size_t countNear(const std::vector<Eigen::Vector2d>& surface,
                      const std::vector<Eigen::Vector2d>& points) {
  std::vector<cv::Point2f> flat;
  flat.reserve(points.size());
  for (const auto& p : points) flat.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  return static_cast<std::size_t>(
      std::count_if(surface.begin(), surface.end(), [&](const Eigen::Vector2d& s) {
        return std::any_of(flat.begin(), flat.end(), [&](const cv::Point2f& p) {
          return std::hypot(p.x - s.x(), p.y - s.y()) <= kNear_m;
        });
      }));
}

std::vector<Eigen::Vector2d> seenSurface(const RobotRecording& robot, const TrueSurfaces& surfaces,
                                         const Sight& sight) {
  std::vector<bool> seen(surfaces.points().size(), false);
  double next_s = 0;
  for (const StampedPose& stamped : robot.truth) {
    if (stamped.time_s < next_s) continue;
    next_s = stamped.time_s + kTruthStep_s;
    for (const std::size_t index : surfaces.visibleFrom(stamped.pose, sight)) seen[index] = true;
  }
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i]) points.push_back(surfaces.points()[i]);
  return points;
}

// The newest time up to `end_s` at which `ask` answers, and its answer.
template <typename Ask>
auto newestAnswer(double begin_s, double end_s, const Ask& ask) -> decltype(ask(end_s)) {
  for (double time_s = end_s; time_s >= begin_s; time_s -= kTfStep_s)
    if (auto answer = ask(time_s)) return answer;
  return {};
}

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

void addRegistration(const RunRecording& run, nlohmann::json& result) {
  result["registered"] = false;
  if (run.registrations.empty()) return;
  const MapRegistration& last = run.registrations.back();
  result["registered"] = last.state == MapRegistration::REGISTERED;
  for (const MapRegistration& registration : run.registrations)
    if (registration.state == MapRegistration::REGISTERED) {
      const RobotRecording& robot = run.robots.at(registration.current_robot);
      result["registered_after_s"] = registration.header.stamp.toSec() - robot.truth.front().time_s;
      break;
    }
  if (!result["registered"]) return;
  const RobotRecording& current = run.robots.at(last.current_robot);
  // tf lags the truth by some of its periods: the end is where both are known.
  const auto error =
      newestAnswer(current.truth.back().time_s - 5, current.truth.back().time_s, [&](double time_s) {
        return relativePoseError(run, last.reference_robot, last.current_robot, time_s);
      });
  if (!error) throw InputError(run.path + ": registered, but no tf between the robots at the end");
  result["relative_error_m"] = error->distance_m;
  result["relative_error_deg"] = error->angle_deg;
}

// The rigid motion of the plane that lays one path on another best; empty for paths without extent.
std::optional<Pose2> fitPaths(const std::vector<Eigen::Vector2d>& target,
                              const std::vector<Eigen::Vector2d>& source) {
  constexpr double kShortest_m = 1;  // root mean square extent; less says too little of the heading
  const auto meanOf = [](const std::vector<Eigen::Vector2d>& points) {
    return Eigen::Vector2d(std::accumulate(points.begin(), points.end(), Eigen::Vector2d(0, 0)) /
                           static_cast<double>(points.size()));
  };
  if (target.empty()) return {};
  const Eigen::Vector2d to_mean = meanOf(target), from_mean = meanOf(source);
  double dot = 0, cross = 0, extent_m2 = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    const Eigen::Vector2d to = target[i] - to_mean, from = source[i] - from_mean;
    dot += from.dot(to);
    cross += from.x() * to.y() - from.y() * to.x();
    extent_m2 += to.squaredNorm();
  }
  if (std::sqrt(extent_m2 / static_cast<double>(target.size())) < kShortest_m) return {};
  Pose2 motion{0, 0, std::atan2(cross, dot)};
  const Eigen::Vector2d shift = to_mean - motion.rotation() * from_mean;
  motion.x_m = shift.x();
  motion.y_m = shift.y();
  return motion;
}

void addCounts(const RunRecording& run, nlohmann::json& result) {
  unsigned frames = 0, dropped = 0;
  for (const auto& [name, robot] : run.robots) {
    if (robot.truth.empty()) continue;
    nlohmann::json& entry = result["robots"][name];
    result["corners"][name] = robot.landmarks.corners.size();
    for (const auto& [stage, counts] : robot.stages) {
      entry[stage] = {{"processed", counts.processed}, {"dropped", counts.dropped}};
      dropped += counts.dropped;
    }
    if (const auto mapper = robot.stages.find("mapper"); mapper != robot.stages.end()) {
      entry["mapping_hz"] =
          mapper->second.processed / (robot.truth.back().time_s - robot.truth.front().time_s);
      frames += mapper->second.processed;
    }
    if (robot.collisions) entry["collisions"] = *robot.collisions;
  }
  result["frames"] = frames;
  result["dropped"] = dropped;
}

// Precision and recall of all maps together, and of each robot's; "_from_start": placed by the start pose
// alone.
void addMaps(const RunRecording& run, const SightOfSurfaces& truth, nlohmann::json& result) {
  for (const auto& [placement, ending] :
       {std::pair(Placement::kTrajectory, ""), std::pair(Placement::kStart, "_from_start")}) {
    MapAccuracy all;
    for (const auto& [name, robot] : run.robots) {
      if (robot.truth.empty() || robot.map.occupied.empty()) continue;
      const auto world_from_map = worldFromMap(run, name, placement);
      if (!world_from_map) continue;
      const MapAccuracy accuracy = mapAccuracy(run, name, *world_from_map, truth);
      result["robots"][name][std::string("map_precision") + ending] =
          ratio(accuracy.occupied_true, accuracy.occupied);
      result["robots"][name][std::string("map_recall") + ending] = ratio(accuracy.seen_mapped, accuracy.seen);
      all.occupied += accuracy.occupied;
      all.occupied_true += accuracy.occupied_true;
      all.seen += accuracy.seen;
      all.seen_mapped += accuracy.seen_mapped;
    }
    result[std::string("map_precision") + ending] = ratio(all.occupied_true, all.occupied);
    result[std::string("map_recall") + ending] = ratio(all.seen_mapped, all.seen);
  }
}

}  // namespace

std::optional<Pose2> truthAt(const RobotRecording& robot, double time_s) {
  const auto after =
      std::lower_bound(robot.truth.begin(), robot.truth.end(), time_s,
                       [](const StampedPose& stamped, double t) { return stamped.time_s < t; });
  if (after == robot.truth.end() || (after == robot.truth.begin() && after->time_s > time_s)) return {};
  if (after == robot.truth.begin()) return after->pose;
  const auto before = after - 1;
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  const Pose2 &a = before->pose, &b = after->pose;
  return Pose2{a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
               wrapAngle(a.yaw_rad + share * wrapAngle(b.yaw_rad - a.yaw_rad))};
}

std::optional<Pose2> worldFromMap(const RunRecording& run, const std::string& robot, Placement placement) {
  std::vector<Eigen::Vector2d> in_map, in_world;
  double next_s = 0;
  for (const StampedPose& stamped : run.robots.at(robot).truth) {
    if (stamped.time_s < next_s) continue;
    const auto map_from_base = transformAt(run, robot + "/map", robot + "/base_link", stamped.time_s);
    if (!map_from_base) continue;
    if (placement == Placement::kStart) return stamped.pose * map_from_base->inverse();
    in_map.push_back(map_from_base->translation());
    in_world.push_back(stamped.pose.translation());
    next_s = stamped.time_s + kTruthStep_s;
  }
  return fitPaths(in_world, in_map);
}

MapAccuracy mapAccuracy(const RunRecording& run, const std::string& robot, const Pose2& world_from_map,
                        const SightOfSurfaces& truth) {
  const RobotRecording& recording = run.robots.at(robot);
  const auto occupied = occupiedPoints(recording.map, world_from_map);
  const auto seen = seenSurface(recording, truth.surfaces, truth.sight);
  MapAccuracy accuracy;
  accuracy.occupied = occupied.size();
  accuracy.occupied_true = static_cast<std::size_t>(std::count_if(
      occupied.begin(), occupied.end(),
      [&](const Eigen::Vector2d& point) { return truth.surfaces.distanceTo(point) <= kNear_m; }));
  accuracy.seen = seen.size();
  accuracy.seen_mapped = countNear(seen, occupied);
  return accuracy;
}

std::optional<RelativePoseError> relativePoseError(const RunRecording& run, const std::string& reference,
                                                   const std::string& other, double time_s) {
  const auto world_from_reference = truthAt(run.robots.at(reference), time_s);
  const auto world_from_other = truthAt(run.robots.at(other), time_s);
  const auto estimate = transformAt(run, reference + "/base_link", other + "/base_link", time_s);
  if (!world_from_reference || !world_from_other || !estimate) return {};
  const Pose2 truth = world_from_reference->inverse() * *world_from_other;
  return RelativePoseError{(truth.translation() - estimate->translation()).norm(),
                           std::abs(wrapAngle(truth.yaw_rad - estimate->yaw_rad)) * 180 / M_PI};
}

nlohmann::json evaluateRun(const RunRecording& run, const Sight& sight) {
  if (run.world_yaml.empty()) throw InputError(run.path + ": no topic /world");
  const TrueSurfaces surfaces(solidsOf(parseWorld(run.world_yaml, run.path + ": /world", ".")));
  nlohmann::json result;
  addRegistration(run, result);
  addCounts(run, result);
  addMaps(run, {surfaces, sight}, result);
  if (!run.real_time_factors.empty())
    result["real_time_factor"] =
        *std::min_element(run.real_time_factors.begin(), run.real_time_factors.end());
  return result;
}

}  // namespace cornerstone
