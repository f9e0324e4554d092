#include "tools/run_metrics.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
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

std::optional<Pose2> worldFromMap(const RunRecording& run, const std::string& robot) {
  const RobotRecording& recording = run.robots.at(robot);
  for (const StampedPose& stamped : recording.truth)
    if (const auto map_from_base = transformAt(run, robot + "/map", robot + "/base_link", stamped.time_s))
      return stamped.pose * map_from_base->inverse();
  return {};
}

MapAccuracy mapAccuracy(const RunRecording& run, const std::string& robot, const TrueSurfaces& surfaces,
                        const Sight& sight) {
  const RobotRecording& recording = run.robots.at(robot);
  const auto world_from_map = worldFromMap(run, robot);
  if (!world_from_map) throw InputError(run.path + ": no tf from the map of robot " + robot + " to its base");
  const auto occupied = occupiedPoints(recording.map, *world_from_map);
  const auto seen = seenSurface(recording, surfaces, sight);
  MapAccuracy accuracy;
  accuracy.occupied = occupied.size();
  accuracy.occupied_true = static_cast<std::size_t>(
      std::count_if(occupied.begin(), occupied.end(),
                    [&](const Eigen::Vector2d& point) { return surfaces.distanceTo(point) <= kNear_m; }));
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
  const World world = parseWorld(run.world_yaml, run.path + ": /world", ".");
  const TrueSurfaces surfaces(solidsOf(world));
  nlohmann::json result, robots;
  addRegistration(run, result);
  MapAccuracy all;
  unsigned frames = 0, dropped = 0;
  for (const auto& [name, robot] : run.robots) {
    if (robot.truth.empty()) continue;
    nlohmann::json& entry = robots[name];
    result["corners"][name] = robot.landmarks.corners.size();
    for (const auto& [stage, counts] : robot.stages) {
      entry[stage] = {{"processed", counts.processed}, {"dropped", counts.dropped}};
      dropped += counts.dropped;
    }
    if (robot.stages.count("mapper") > 0) {
      const unsigned mapped = robot.stages.at("mapper").processed;
      entry["mapping_hz"] = mapped / (robot.truth.back().time_s - robot.truth.front().time_s);
      frames += mapped;
    }
    if (robot.collisions) entry["collisions"] = *robot.collisions;
    if (robot.map.occupied.empty()) continue;
    const MapAccuracy accuracy = mapAccuracy(run, name, surfaces, sight);
    entry["map_precision"] = ratio(accuracy.occupied_true, accuracy.occupied);
    entry["map_recall"] = ratio(accuracy.seen_mapped, accuracy.seen);
    all.occupied += accuracy.occupied;
    all.occupied_true += accuracy.occupied_true;
    all.seen += accuracy.seen;
    all.seen_mapped += accuracy.seen_mapped;
  }
  result["map_precision"] = ratio(all.occupied_true, all.occupied);
  result["map_recall"] = ratio(all.seen_mapped, all.seen);
  result["frames"] = frames;
  result["dropped"] = dropped;
  if (!run.real_time_factors.empty())
    result["real_time_factor"] =
        *std::min_element(run.real_time_factors.begin(), run.real_time_factors.end());
  result["robots"] = robots;
  return result;
}

}  // namespace cornerstone
