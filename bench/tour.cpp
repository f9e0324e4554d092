#include "tour.h"

#include <algorithm>
#include <cmath>

namespace cornerstone::bench {
namespace {
constexpr double kNear_m = 0.10;
constexpr float kOccupied = 0.65F;
}  // namespace

World shippedWorld(const std::string& name) {
  return loadWorld(std::string(CORNERSTONE_SOURCE_DIR) + "/worlds/" + name);
}

StereoMounting mountingOf(const RigParams& rig) {
  const auto cameras = calibrationsOf(rig);
  return {makeRig(cameras[0], cameras[1], cameras[2]), baseFromCameras(rig)[0]};
}

RigParams rigOf(int width_px) {
  RigParams rig;
  rig.width_px = width_px;
  rig.height_px = width_px * 3 / 4;
  return rig;
}

int maxDisparityOf(int width_px) { return std::min(width_px / 5, 96); }

Eigen::Isometry3d spatial(const Pose2& pose) {
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  isometry.translation() = Eigen::Vector3d(pose.x_m, pose.y_m, 0);
  return isometry;
}

void drive(const World& world, const SimulationParams& params,
           const std::function<void(const RobotFrame&)>& look) {
  Simulation simulation(world, params);
  while (!simulation.routesDone()) {
    if (simulation.frameDue())
      for (const RobotFrame& frame : simulation.frames()) look(frame);
    simulation.step();
  }
}

MapQuality qualityOf(const GridMap& map, const World& world, const std::vector<Pose2>& world_from_bases) {
  const TrueSurfaces truth(solidsOf(world));
  std::vector<Eigen::Vector2d> occupied;
  std::size_t right = 0;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      if (map.occupied(row, col) <= kOccupied) continue;
      occupied.push_back(map.geometry.centreOf({col, row}));
      if (truth.distanceTo(occupied.back()) <= kNear_m) ++right;
    }
  std::vector<bool> seen(truth.points().size(), false);
  for (std::size_t i = 0; i < world_from_bases.size(); i += 2)
    for (const std::size_t point : truth.visibleFrom(world_from_bases[i], Sight{})) seen[point] = true;
  std::size_t seen_count = 0, mapped = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) continue;
    ++seen_count;
    const Eigen::Vector2d& point = truth.points()[i];
    if (std::any_of(occupied.begin(), occupied.end(),
                    [&](const Eigen::Vector2d& cell) { return (cell - point).norm() <= kNear_m; }))
      ++mapped;
  }
  const auto share = [](std::size_t part, std::size_t all) {
    return all == 0 ? 0 : double(part) / double(all);
  };
  return {share(right, occupied.size()), share(mapped, seen_count)};
}

}  // namespace cornerstone::bench
