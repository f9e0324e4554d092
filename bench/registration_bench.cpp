// The pose of one map in another: cornerstone, corner detection included, beside MRPT's aligner.
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "bench.h"
#include "cornerstone/scan/column_scan.h"
#include "peers.h"
#include "tour.h"

namespace cornerstone::bench {
namespace {

constexpr int kRepeats = 7;
constexpr double kRight_m = 0.5, kRight_rad = 5 * M_PI / 180;

struct PlacedMap {
  GridMap map;
  Pose2 world_from_map;
};

// The maps of a world's robots in the frames of their starts, in one run: at true poses, and with their
// odometry.
struct RobotMaps {
  std::map<std::string, PlacedMap> true_poses, driven;
};

RobotMaps mapsOf(const std::string& world) {
  SimulationParams params;
  params.steps_per_frame = params.steps_per_second / 5;
  PipelineParams fitted, placed;
  placed.mapper.fit_scans = false;
  struct Robot {
    Pose2 world_from_start;
    RobotPipeline driven, at_truth;
  };
  std::map<std::string, Robot> robots;
  const StereoMounting mounting = mountingOf(params.rig);
  drive(shippedWorld(world), params, [&](const RobotFrame& frame) {
    auto at = robots.find(frame.robot);
    if (at == robots.end())
      at = robots
               .emplace(frame.robot, Robot{frame.world_from_base * frame.odom_from_base.inverse(),
                                           RobotPipeline(mounting, fitted), RobotPipeline(mounting, placed)})
               .first;
    const StereoImages images{frame.images[0], frame.images[1], frame.images[2]};
    at->second.driven.update(images, frame.odom_from_base);
    at->second.at_truth.update(images, at->second.world_from_start.inverse() * frame.world_from_base);
  });
  RobotMaps maps;
  for (const auto& [name, robot] : robots) {
    maps.driven[name] = {robot.driven.map(), robot.world_from_start};
    maps.true_poses[name] = {robot.at_truth.map(), robot.world_from_start};
  }
  return maps;
}

// Every other scan of a laser log with its poses, in a frame of its own, by MRPT's insertion.
PlacedMap laserMap(const mrpt::maps::CSimpleMap& log, std::size_t first, const Pose2& map_from_world) {
  mrpt::maps::COccupancyGridMap2D grid(0, 1, 0, 1, 0.05F);
  for (std::size_t i = first; i < log.size(); i += 2) {
    const auto [pose, frame] = log.get(i);
    const mrpt::poses::CPose3D at =
        mrpt::poses::CPose3D(map_from_world.x_m, map_from_world.y_m, 0, map_from_world.yaw_rad, 0, 0) +
        pose->getMeanVal();
    for (const auto& observation : *frame) grid.insertObservation(*observation, at);
  }
  return {fromMrpt(grid), map_from_world.inverse()};
}

struct Answers {
  std::vector<double> times_ms, errors_m, errors_rad;
  int accepted = 0, right = 0;
};

void note(const std::optional<Pose2>& answer, const Pose2& truth, Answers& answers) {
  if (!answer) return;
  ++answers.accepted;
  const Pose2 error = truth.inverse() * *answer;
  answers.errors_m.push_back(error.translation().norm());
  answers.errors_rad.push_back(std::abs(error.yaw_rad));
  if (answers.errors_m.back() < kRight_m && answers.errors_rad.back() < kRight_rad) ++answers.right;
}

std::vector<std::string> refusals;  // cornerstone's own words

// `solvable`: false for maps of different buildings, which have no true pose.
void compare(const std::string& pair, const PlacedMap& reference, const PlacedMap& current, bool solvable) {
  const Pose2 truth = reference.world_from_map.inverse() * current.world_from_map;
  Answers ours, bare, mrpt, tuned_bare, tuned, features;
  std::string refusal;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::optional<Pose2> answer;
    ours.times_ms.push_back(elapsed_ms([&] {
      answer.reset();
      const Landmarks a = detectLandmarks(reference.map, {}), b = detectLandmarks(current.map, {});
      const auto [found, reason] = registerMaps(MapView{reference.map, a}, MapView{current.map, b}, {}, {});
      refusal = reason;
      if (found) answer = found->reference_from_current;
    }));
    note(answer, truth, ours);
    const auto peer = [&](Answers& answers, const auto& align) {
      answers.times_ms.push_back(elapsed_ms([&] { answer = align(); }));
      note(answer, truth, answers);
    };
    peer(bare, [&] { return alignMrpt(reference.map, current.map, MrptAligner::kGrids); });
    peer(mrpt, [&] { return alignMrpt(reference.map, current.map, MrptAligner::kGridsAndPoints); });
    peer(tuned_bare,
         [&] { return alignMrpt(reference.map, current.map, MrptAligner::kMoreFeaturesOnGrids); });
    peer(tuned, [&] { return alignMrpt(reference.map, current.map, MrptAligner::kMoreFeatures); });
    peer(features, [&] { return alignFeatures(reference.map, current.map); });
  }
  const double mrpt_ms = median(mrpt.times_ms);
  const auto row = [&](const std::string& name, const Answers& answers) {
    const bool any = answers.accepted > 0 && solvable;
    const double ms = median(answers.times_ms);
    printRow({pair, name, solvable ? std::to_string(answers.right) : "-",
              std::to_string(solvable ? answers.accepted - answers.right : answers.accepted),
              std::to_string(kRepeats - answers.accepted), any ? text(median(answers.errors_m), 3) : "",
              any ? text(median(answers.errors_rad) * 180 / M_PI, 2) : "", text(ms, 1), text(ms / mrpt_ms)});
  };
  row("cornerstone", ours);
  row("CGridMapAligner, grids alone", bare);
  row("CGridMapAligner, grids and points", mrpt);
  row("CGridMapAligner, more features, grids alone", tuned_bare);
  row("CGridMapAligner, more features, grids and points", tuned);
  row("AKAZE features, affine RANSAC", features);
  if (!refusal.empty()) refusals.push_back(pair + ": " + refusal);
}

void compareLasers() {
  const std::filesystem::path folder("/usr/share/mrpt/datasets");
  for (const char* name : {"localization_demo.simplemap.gz", "malaga-cs-fac-building.simplemap.gz"}) {
    mrpt::maps::CSimpleMap log;
    if (!std::filesystem::exists(folder / name) || !log.loadFromFile((folder / name).string())) {
      std::fprintf(stderr, "bench: %s is missing (Debian package mrpt-common): left out\n", name);
      continue;
    }
    compare(std::string("`") + name + "`, even and odd scans", laserMap(log, 0, {}),
            laserMap(log, 1, {-4.3, 2.9, 1.9}), true);
  }
}

}  // namespace

void registrationPart() {
  std::puts(
      "\n## Registration of two maps\n\nNo prior, every pose possible; 7 repeats in turns (MRPT's aligner is "
      "random). "
      "Right: within 0.5 m and 5 degrees of the truth; error and time are medians over the accepted answers "
      "and over "
      "all repeats. Stereo maps: 160x120, 5 Hz, each robot's map in the frame of its start; with odometry "
      "the truth "
      "is where the robots truly started, and the maps' own drift counts against the answer. Laser maps: "
      "`/usr/share/mrpt/datasets`, MRPT's insertion at the log's poses, the second map in a frame turned by "
      "109 "
      "degrees. cornerstone's time contains the detection of corners in both maps. CGridMapAligner: default "
      "options, "
      "the likeliest mode of its answer; its time contains the copy into MRPT's maps; with the occupied "
      "cells as a point "
      "map beside the grid it checks its modes by ICP, on grids alone it does not; its other rows take three "
      "times the default's features (0.05 a square metre) and half the consensus (0.1). AKAZE: the "
      "map-merging recipe, features of "
      "the maps as grey pictures, matched with a ratio of 0.8, at least 12 inliers of a similarity of scale "
      "0.9 to "
      "1.1 within 3 cells. Different buildings: "
      "every "
      "answer is wrong.");
  printHead({"pair", "method", "right", "wrong", "refused", "error m", "error deg", "ms",
             "time / CGridMapAligner with points"});
  const RobotMaps office = mapsOf("office.yaml"), elsewhere = mapsOf("other_building.yaml");
  compare("office a, b: true poses", office.true_poses.at("a"), office.true_poses.at("b"), true);
  compare("office a, b: odometry, scans fitted", office.driven.at("a"), office.driven.at("b"), true);
  compareLasers();
  for (const auto& [name, other] : elsewhere.true_poses)
    compare("office a, other building " + name, office.true_poses.at("a"), other, false);
  std::puts("\nWhy cornerstone refused, in its own words:\n");
  for (const std::string& refusal : refusals) std::puts(("- " + refusal).c_str());
}

}  // namespace cornerstone::bench
