// The paper's experiment: two robots with drifting odometry map the same place from different starts and
// meet. How well is each placed in the other's map, and is a wrong frame ever given?
#include <cmath>
#include <map>
#include <optional>

#include "bench.h"
#include "peers.h"
#include "tour.h"

namespace cornerstone::bench {
namespace {

constexpr double kRight_m = 0.5, kRight_rad = 5 * M_PI / 180;
// What is wrong with the rough relative start that the robots are told.
const Pose2 kRough{0.3, -0.25, 6 * M_PI / 180};

struct MappingRobot {
  RobotPipeline pipeline;
  Pose2 world_from_map;  // where it truly started
  Pose2 world_from_base, odom_from_base;

  Pose2 mapFromBase() const { return pipeline.mapper().mapFromOdom() * odom_from_base; }
};
using Robots = std::map<std::string, MappingRobot>;

Robots tour(const std::string& world, int seed) {
  SimulationParams params;
  params.seed = seed;
  params.rig.width_px = 160;
  params.rig.height_px = 120;
  const StereoMounting mounting = mountingOf(params.rig);
  Robots robots;
  drive(shippedWorld(world), params, [&](const RobotFrame& frame) {
    auto at = robots.find(frame.robot);
    if (at == robots.end())
      at = robots
               .emplace(frame.robot, MappingRobot{RobotPipeline(mounting, {}),
                                                  frame.world_from_base * frame.odom_from_base.inverse(),
                                                  {},
                                                  {}})
               .first;
    MappingRobot& robot = at->second;
    robot.world_from_base = frame.world_from_base;
    robot.odom_from_base = frame.odom_from_base;
    if (!frame.images[0].empty())
      robot.pipeline.update({frame.images[0], frame.images[1], frame.images[2]}, frame.odom_from_base);
  });
  return robots;
}

using Answer = std::optional<Pose2>;

struct Errors {
  std::vector<double> m, rad;
  int right = 0, wrong = 0, refused = 0;

  // Of one robot in the other's frame, as each knows itself and the answer joins them.
  void note(const Answer& answer, const MappingRobot& a, const MappingRobot& b) {
    if (!answer) {
      ++refused;
      return;
    }
    const Pose2 told = a.mapFromBase().inverse() * *answer * b.mapFromBase();
    const Pose2 error = (a.world_from_base.inverse() * b.world_from_base).inverse() * told;
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

Answer ours(const MappingRobot& a, const MappingRobot& b, bool told) {
  RegistrationHints hints;
  if (told) hints.prior = a.world_from_map.inverse() * b.world_from_map * kRough;
  hints.focus_in_current_m = b.mapFromBase().translation();
  const GridMap there = a.pipeline.map(), here = b.pipeline.map();
  const Landmarks of_a = detectLandmarks(there, {}), of_b = detectLandmarks(here, {});
  const auto [found, refusal] = registerMaps(MapView{there, of_a}, MapView{here, of_b}, hints, {});
  return found ? Answer(found->reference_from_current) : std::nullopt;
}

struct Method {
  std::string name;
  std::function<Answer(const MappingRobot&, const MappingRobot&)> align;
};

std::vector<Method> methods() {
  const auto mrpt = [](MrptAligner kind) {
    return [kind](const MappingRobot& a, const MappingRobot& b) {
      return alignMrpt(a.pipeline.map(), b.pipeline.map(), kind);
    };
  };
  return {{"cornerstone, roughly told",
           [](const MappingRobot& a, const MappingRobot& b) { return ours(a, b, true); }},
          {"cornerstone, told nothing",
           [](const MappingRobot& a, const MappingRobot& b) { return ours(a, b, false); }},
          {"CGridMapAligner, grids alone", mrpt(MrptAligner::kGrids)},
          {"CGridMapAligner, grids and points", mrpt(MrptAligner::kGridsAndPoints)},
          {"CGridMapAligner, more features, grids alone", mrpt(MrptAligner::kMoreFeaturesOnGrids)},
          {"CGridMapAligner, more features, grids and points", mrpt(MrptAligner::kMoreFeatures)},
          {"AKAZE features, affine RANSAC", [](const MappingRobot& a, const MappingRobot& b) {
             return alignFeatures(a.pipeline.map(), b.pipeline.map());
           }}};
}

}  // namespace

void registrationMeetingPart(int seeds) {
  std::printf(
      "\n### Two robots meet\n\nThe paper's experiment in simulation: 160x120, odometry drifting, both "
      "robots map "
      "while they "
      "drive; at the end each is placed in the other's frame. %d seeds a world. Right: within 0.5 m and 5 "
      "degrees; "
      "errors are the robots' relative pose, so that what drifted inside the maps counts. Roughly told: the "
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
        errors[i].note(all[i].align(robots.at("a"), robots.at("b")), robots.at("a"), robots.at("b"));
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
