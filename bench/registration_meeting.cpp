// The paper's experiment: two robots with drifting odometry map the same place from different starts and
// meet. How well is each placed in the other's map, and is a wrong frame ever given?
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "bench.h"
#include "cornerstone/stereo/self_calibration.h"
#include "peers.h"
#include "tour.h"

namespace cornerstone::bench {
namespace {

constexpr double kRight_m = 0.5, kRight_rad = 5 * M_PI / 180;
// What is wrong with the rough relative start that the robots are told.
const Pose2 kRough{0.3, -0.25, 6 * M_PI / 180};

// Where a robot truly was, and where its map has that place.
struct Place {
  Pose2 world_from_base;
  Pose2 map_from_base;
};

// What a robot knows in the end: its map, where it is now and where it has been.
struct Known {
  GridMap map;
  Place now;
  std::vector<Place> before;
  std::vector<Eigen::Vector2d> way_m;
};

struct MappingRobot {
  StereoMatcher matcher{{}};
  SelfCalibration calibration;
  Mapper mapper;
  Mapper guided;         // the same scans at true poses: what drift alone spoils
  Pose2 world_from_map;  // where it truly started
  Pose2 world_from_base, odom_from_base;
  std::vector<Pose2> world_from_frames;  // of the mapper's key frames

  Known byItself() const {
    Known known{mapper.map(), {world_from_base, mapper.mapFromOdom() * odom_from_base}, {}, mapper.way()};
    for (std::size_t i = 0; i < world_from_frames.size(); ++i)
      known.before.push_back({world_from_frames[i], mapper.graph().frames()[i].map_from_base});
    return known;
  }
  Known byTruth() const {
    const auto placeAt = [&](const Pose2& truth) { return Place{truth, world_from_map.inverse() * truth}; };
    Known known{guided.map(), placeAt(world_from_base), {}, guided.way()};
    for (const Pose2& truth : world_from_frames) known.before.push_back(placeAt(truth));
    return known;
  }
};
using Robots = std::map<std::string, MappingRobot>;

MapperParams guidedParams() {
  MapperParams params;
  params.fit_scans = false;
  return params;
}

Robots tour(const std::string& world, int seed) {
  SimulationParams params;
  params.seed = seed;
  params.rig.width_px = 160;
  params.rig.height_px = 120;
  const StereoMounting mounting = mountingOf(params.rig);
  Robots robots;
  const ScanParams scan_params;
  drive(shippedWorld(world), params, [&](const RobotFrame& frame) {
    auto at = robots.find(frame.robot);
    if (at == robots.end()) {
      at = robots
               .emplace(frame.robot, MappingRobot{StereoMatcher({}),
                                                  {},
                                                  Mapper({}, scan_params.levels.size()),
                                                  Mapper(guidedParams(), scan_params.levels.size()),
                                                  frame.world_from_base * frame.odom_from_base.inverse(),
                                                  {},
                                                  {},
                                                  {}})
               .first;
    }
    MappingRobot& robot = at->second;
    robot.world_from_base = frame.world_from_base;
    robot.odom_from_base = frame.odom_from_base;
    if (frame.images[0].empty()) return;
    const StereoImages images{frame.images[0], frame.images[1], frame.images[2]};
    Disparity disparity = robot.matcher.match(images, mounting.rig);
    robot.calibration.correct(images, disparity);
    const RangeScan scan = scanFromDisparity(disparity, mounting.base_from_camera, scan_params);
    robot.mapper.update(scan, frame.odom_from_base);
    if (robot.mapper.graph().frames().size() > robot.world_from_frames.size())
      robot.world_from_frames.push_back(frame.world_from_base);
    robot.guided.update(scan, robot.world_from_map.inverse() * frame.world_from_base);
  });
  return robots;
}

// Of where one robot is from the other, as an alignment of their maps has it.
Pose2 errorOf(const Place& a, const Place& b, const Pose2& a_from_b) {
  const Pose2 truth = a.world_from_base.inverse() * b.world_from_base;
  return truth.inverse() * (a.map_from_base.inverse() * a_from_b * b.map_from_base);
}

struct Errors {
  std::vector<double> m, rad;
  void note(const Pose2& error) {
    m.push_back(error.translation().norm());
    rad.push_back(std::abs(error.yaw_rad));
  }
};

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The mean over all pairs of places about as near to each other as the nearest ones.
Errors whereTheyMet(const Known& a, const Known& b, const Pose2& a_from_b) {
  constexpr double kAsNear_m = 0.25;  // between two key frames
  const auto distance_m = [](const Place& x, const Place& y) {
    return (x.world_from_base.translation() - y.world_from_base.translation()).norm();
  };
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Place& x : a.before)
    for (const Place& y : b.before) nearest_m = std::min(nearest_m, distance_m(x, y));
  Errors of_pairs;
  for (const Place& x : a.before)
    for (const Place& y : b.before)
      if (distance_m(x, y) <= nearest_m + kAsNear_m) of_pairs.note(errorOf(x, y, a_from_b));
  return {{mean(of_pairs.m)}, {mean(of_pairs.rad)}};
}

struct Tally {
  Errors now, where_they_met;
  int right = 0, wrong = 0, refused = 0;

  void note(const std::optional<Pose2>& a_from_b, const Known& a, const Known& b) {
    if (!a_from_b) {
      ++refused;
      return;
    }
    const Pose2 error = errorOf(a.now, b.now, *a_from_b);
    const bool good = error.translation().norm() < kRight_m && std::abs(error.yaw_rad) < kRight_rad;
    ++(good ? right : wrong);
    if (!good) return;
    now.note(error);
    const Errors met = whereTheyMet(a, b, *a_from_b);
    where_they_met.m.push_back(met.m.front());
    where_they_met.rad.push_back(met.rad.front());
  }
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

// The pose of b's map in a's; prior: roughly told.
using Align = std::function<std::optional<Pose2>(const Known& a, const Known& b, const Pose2& prior)>;

std::optional<Pose2> ours(const Known& a, const Known& b, const std::optional<Pose2>& prior) {
  RegistrationHints hints;
  hints.prior = prior;
  hints.focus_in_current_m = b.now.map_from_base.translation();
  const Landmarks of_a = detectLandmarks(a.map, {}), of_b = detectLandmarks(b.map, {});
  const auto [found, refusal] =
      registerMaps(MapView{a.map, of_a, a.way_m}, MapView{b.map, of_b, b.way_m}, hints, {});
  return found ? std::optional(found->reference_from_current) : std::nullopt;
}

struct Method {
  std::string name;
  Align align;
  bool true_poses = false;
};

std::vector<Method> methods() {
  const auto mrpt = [](MrptAligner kind) {
    return [kind](const Known& a, const Known& b, const Pose2&) { return alignMrpt(a.map, b.map, kind); };
  };
  const auto told = [](const Known& a, const Known& b, const Pose2& prior) { return ours(a, b, prior); };
  return {{"cornerstone, roughly told", told},
          {"cornerstone, told nothing",
           [](const Known& a, const Known& b, const Pose2&) { return ours(a, b, std::nullopt); }},
          {"cornerstone, roughly told, maps at true poses", told, true},
          {"CGridMapAligner, grids alone", mrpt(MrptAligner::kGrids)},
          {"CGridMapAligner, grids and points", mrpt(MrptAligner::kGridsAndPoints)},
          {"CGridMapAligner, more features, grids alone", mrpt(MrptAligner::kMoreFeaturesOnGrids)},
          {"CGridMapAligner, more features, grids and points", mrpt(MrptAligner::kMoreFeatures)},
          {"AKAZE features, affine RANSAC",
           [](const Known& a, const Known& b, const Pose2&) { return alignFeatures(a.map, b.map); }}};
}

std::vector<std::string> columnsOf(const Errors& errors) {
  if (errors.m.empty()) return {"", "", ""};
  return {text(1e3 * quantile(errors.m, 0.5), 1), text(1e3 * quantile(errors.m, 0.95), 1),
          text(quantile(errors.rad, 0.5) * 180 / M_PI, 3)};
}

void printWorld(const std::string& world, int seeds) {
  const std::vector<Method> all = methods();
  std::vector<Tally> tallies(all.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    const Robots robots = tour(world, seed);
    const MappingRobot &a = robots.at("a"), &b = robots.at("b");
    const Pose2 prior = a.world_from_map.inverse() * b.world_from_map * kRough;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Known of_a = all[i].true_poses ? a.byTruth() : a.byItself();
      const Known of_b = all[i].true_poses ? b.byTruth() : b.byItself();
      tallies[i].note(all[i].align(of_a, of_b, prior), of_a, of_b);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Tally& tally = tallies[i];
    std::vector<std::string> row{world, all[i].name, std::to_string(tally.right), std::to_string(tally.wrong),
                                 std::to_string(tally.refused)};
    for (const Errors& errors : {tally.where_they_met, tally.now})
      for (const std::string& column : columnsOf(errors)) row.push_back(column);
    printRow(row);
  }
}

}  // namespace

void registrationMeetingPart(int seeds) {
  std::printf(
      "\n### Two robots meet\n\nThe paper's experiment in simulation: 160x120, odometry drifting, both "
      "robots "
      "map while they drive; at the end their maps are joined. %d seeds a world. Errors are of one robot's "
      "pose as seen from the other; first of where their ways came nearest to each other, as in the paper "
      "(the mean over all pairs of key frames 0.25 m farther apart at most), then of where they are in the "
      "end, up to 4 m of corridor from there: what drifted since counts. Right: within 0.5 m and 5 degrees "
      "in "
      "the end. Median, 95th percentile and the median of the yaw. Roughly told: the relative start, wrong "
      "by "
      "%.2f m and %.0f degrees.\n\n",
      seeds, kRough.translation().norm(), kRough.yaw_rad * 180 / M_PI);
  printHead({"world", "method", "right", "wrong", "refused", "where they met: mm", "95 %", "deg",
             "in the end: mm", "95 %", "deg"});
  for (const std::string world : {"corridor_crossing.yaml", "office.yaml", "other_building.yaml"})
    printWorld(world, seeds);
}

}  // namespace cornerstone::bench
