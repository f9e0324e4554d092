// A world's robots on their scripted routes through the simulator, and how good a map of it is.
#pragma once

#include <functional>
#include <string>

#include "cornerstone/mapping/grid_map.h"
#include "cornerstone/pipeline/robot_pipeline.h"
#include "cornerstone/simulation/simulation.h"

namespace cornerstone::bench {

World shippedWorld(const std::string& name);
StereoMounting mountingOf(const RigParams& rig);
RigParams rigOf(int width_px);     // the default rig with images of 4:3
int maxDisparityOf(int width_px);  // 32 px at 160, 64 at 320, 96 at 640: ranges from 0.3, at 640 from 0.4 m
Eigen::Isometry3d spatial(const Pose2& pose);

// Calls `look` with every frame of every robot.
void drive(const World& world, const SimulationParams& params,
           const std::function<void(const RobotFrame&)>& look);

struct MapQuality {
  double precision = 0;  // of the occupied cells (above 0.65), within 0.10 m of a true surface
  double recall = 0;     // of the surfaces seen within 3 m along the route, within 0.10 m of an occupied cell
};
// The map's frame is the world's.
MapQuality qualityOf(const GridMap& map, const World& world, const std::vector<Pose2>& world_from_bases);

}  // namespace cornerstone::bench
