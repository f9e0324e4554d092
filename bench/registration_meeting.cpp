// The paper's experiment: two robots with drifting odometry map the same place from different starts and
// meet. How well is each placed in the other's map, and is a wrong frame ever given?
#include <cmath>
#include <map>
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

// Where a robot's map has it, and the map.
struct Known {
  GridMap map;
  Pose2 map_from_base;
};

struct MappingRobot {
  StereoMatcher matcher{{}};
  SelfCalibration calibration;
  Mapper mapper;
  Mapper guided;         // the same scans at true poses: what drift alone spoils
  Pose2 world_from_map;  // where it truly started
  Pose2 world_from_base, odom_from_base;

  Known byItself() const { return {mapper.map(), mapper.mapFromOdom() * odom_from_base}; }
  Known byTruth() const { return {guided.map(), world_from_map.inverse() * world_from_base}; }
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
    robot.guided.update(scan, robot.world_from_map.inverse() * frame.world_from_base);
  });
  return robots;
}

struct Errors {
  std::vector<double> m, rad;
  int right = 0, wrong = 0, refused = 0;

  void note(const std::optional<Pose2>& told, const MappingRobot& a, const MappingRobot& b) {
    if (!told) {
      ++refused;
      return;
    }
    const Pose2 error = (a.world_from_base.inverse() * b.world_from_base).inverse() * *told;
    const bool good = error.translation().norm() < kRight_m && std::abs(error.yaw_rad) < kRight_rad;
    ++(good ? right : wrong);
    if (!good) return;
    m.push_back(error.translation().norm());
    rad.push_back(std::abs(error.yaw_rad));
  }
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

// Of robot b in robot a's frame, as each knows itself and an alignment of their maps joins them.
using Align = std::function<std::optional<Pose2>(const Known& a, const Known& b)>;

std::optional<Pose2> ours(const Known& a, const Known& b, const std::optional<Pose2>& prior) {
  RegistrationHints hints;
  hints.prior = prior;
  hints.focus_in_current_m = b.map_from_base.translation();
  const Landmarks of_a = detectLandmarks(a.map, {}), of_b = detectLandmarks(b.map, {});
  const auto [found, refusal] = registerMaps(MapView{a.map, of_a}, MapView{b.map, of_b}, hints, {});
  return found ? std::optional(found->reference_from_current) : std::nullopt;
}

struct Method {
  std::string name;
  std::function<std::optional<Pose2>(const MappingRobot&, const MappingRobot&)> told;
};

std::optional<Pose2> joined(const Known& a, const Known& b, const Align& align) {
  const auto a_from_b = align(a, b);
  if (!a_from_b) return std::nullopt;
  return a.map_from_base.inverse() * *a_from_b * b.map_from_base;
}

std::vector<Method> methods() {
  const auto roughly = [](const MappingRobot& a, const MappingRobot& b) {
    return a.world_from_map.inverse() * b.world_from_map * kRough;
  };
  const auto peer = [](const std::function<std::optional<Pose2>(const GridMap&, const GridMap&)>& align) {
    return [align](const MappingRobot& a, const MappingRobot& b) {
      return joined(a.byItself(), b.byItself(),
                    [&](const Known& of_a, const Known& of_b) { return align(of_a.map, of_b.map); });
    };
  };
  const auto mrpt = [&](MrptAligner kind) {
    return peer([kind](const GridMap& a, const GridMap& b) { return alignMrpt(a, b, kind); });
  };
  return {{"cornerstone, roughly told",
           [=](const MappingRobot& a, const MappingRobot& b) {
             return joined(a.byItself(), b.byItself(),
                           [&](const Known& x, const Known& y) { return ours(x, y, roughly(a, b)); });
           }},
          {"cornerstone, told nothing",
           [](const MappingRobot& a, const MappingRobot& b) {
             return joined(a.byItself(), b.byItself(),
                           [](const Known& x, const Known& y) { return ours(x, y, std::nullopt); });
           }},
          {"cornerstone, roughly told, maps at true poses",
           [=](const MappingRobot& a, const MappingRobot& b) {
             return joined(a.byTruth(), b.byTruth(),
                           [&](const Known& x, const Known& y) { return ours(x, y, roughly(a, b)); });
           }},
          {"CGridMapAligner, grids alone", mrpt(MrptAligner::kGrids)},
          {"CGridMapAligner, grids and points", mrpt(MrptAligner::kGridsAndPoints)},
          {"CGridMapAligner, more features, grids alone", mrpt(MrptAligner::kMoreFeaturesOnGrids)},
          {"CGridMapAligner, more features, grids and points", mrpt(MrptAligner::kMoreFeatures)},
          {"AKAZE features, affine RANSAC", peer(alignFeatures)}};
}

}  // namespace

void registrationMeetingPart(int seeds) {
  std::printf(
      "\n### Two robots meet\n\nThe paper's experiment in simulation: 160x120, odometry drifting, both "
      "robots map "
      "while they "
      "drive; at the end each is placed in the other's frame. %d seeds a world. Right: within 0.5 m and 5 "
      "degrees; "
      "errors are the robots' relative pose, so that what drifted inside the maps counts, but in the row of "
      "maps at true poses. Roughly told: the "
      "relative "
      "start, wrong by %.2f m and %.0f degrees.\n\n",
      seeds, kRough.translation().norm(), kRough.yaw_rad * 180 / M_PI);
  printHead({"world", "method", "right", "wrong", "refused", "error mm", "95 %", "yaw deg"});
  for (const std::string world : {"corridor_crossing.yaml", "office.yaml", "other_building.yaml"}) {
    const std::vector<Method> all = methods();
    std::vector<Errors> errors(all.size());
    for (int seed = 1; seed <= seeds; ++seed) {
      const Robots robots = tour(world, seed);
      for (std::size_t i = 0; i < all.size(); ++i)
        errors[i].note(all[i].told(robots.at("a"), robots.at("b")), robots.at("a"), robots.at("b"));
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Errors& e = errors[i];
      printRow({world, all[i].name, std::to_string(e.right), std::to_string(e.wrong),
                std::to_string(e.refused), e.m.empty() ? "" : text(1e3 * quantile(e.m, 0.5), 1),
                e.m.empty() ? "" : text(1e3 * quantile(e.m, 0.95), 1),
                e.m.empty() ? "" : text(quantile(e.rad, 0.5) * 180 / M_PI, 3)});
    }
  }
}

}  // namespace cornerstone::bench
