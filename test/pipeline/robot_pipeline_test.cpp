#include "cornerstone/pipeline/robot_pipeline.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "cornerstone/base/errors.h"
#include "cornerstone/simulation/simulation.h"

namespace cornerstone {
namespace {

World shippedWorld(const std::string& name) {
  return loadWorld(std::string(CORNERSTONE_SOURCE_DIR) + "/worlds/" + name);
}

StereoMounting mountingOf(const RigParams& rig) {
  const auto cameras = calibrationsOf(rig);
  return {makeRig(cameras[0], cameras[1], cameras[2]), baseFromCameras(rig)[0]};
}

// Both robots of a world after their routes, and where they stood at the start and at the end.
struct Tour {
  std::map<std::string, RobotPipeline> robots;
  std::map<std::string, Pose2> world_from_start, world_from_base;
  std::map<std::string, int> collisions;
};

Tour driveThrough(const World& world, int seed) {
  SimulationParams params;
  params.seed = seed;
  Simulation simulation(world, params);
  Tour tour;
  while (!simulation.routesDone()) {
    if (simulation.frameDue()) {
      for (const RobotFrame& frame : simulation.frames()) {
        RobotPipeline& robot =
            tour.robots.try_emplace(frame.robot, mountingOf(params.rig), PipelineParams{}).first->second;
        robot.update({frame.images[0], frame.images[1], frame.images[2]}, frame.odom_from_base);
        tour.world_from_start.try_emplace(frame.robot, frame.world_from_base);
        tour.world_from_base[frame.robot] = frame.world_from_base;
        tour.collisions[frame.robot] = frame.collisions;
      }
    }
    simulation.step();
  }
  return tour;
}

// Share of the map's occupied cells that lie within 0.10 m of something that stands there.
double precisionOf(const GridMap& map, const Pose2& world_from_map, const TrueSurfaces& truth) {
  int occupied = 0, right = 0;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      if (map.occupied(row, col) <= 0.65f) continue;
      ++occupied;
      if (truth.distanceTo(world_from_map * map.geometry.centreOf({col, row})) <= 0.10) ++right;
    }
  return occupied == 0 ? 0 : double(right) / occupied;
}

TEST(RobotPipeline, TwoRobotsOfOneOfficeFindTheirRelativePoseAndThoseOfAnotherBuildingDoNot) {
  const World world = shippedWorld("office.yaml");
  const Tour tour = driveThrough(world, 6);
  const TrueSurfaces truth(solidsOf(world));
  for (const auto& [name, robot] : tour.robots) {
    EXPECT_EQ(tour.collisions.at(name), 0) << name;
    // The frame is placed where the robot started: what the map drifts over 35 m counts against it.
    EXPECT_GE(precisionOf(robot.map(), tour.world_from_start.at(name), truth), 0.80) << name;
    const Pose2 true_motion = tour.world_from_start.at(name).inverse() * tour.world_from_base.at(name);
    const Pose2 error = true_motion.inverse() * robot.mapper().pose().map_from_base;
    EXPECT_LT(error.translation().norm(), 0.15) << name;
    EXPECT_LT(std::abs(error.yaw_rad), 0.03) << name;
  }
  std::string refusal;
  const auto answer = registerRobots(tour.robots.at("a"), tour.robots.at("b"), {}, &refusal);
  ASSERT_TRUE(answer) << refusal;
  // As it matters: where robot b is in robot a's map.
  const Pose2 true_pose = tour.world_from_start.at("a").inverse() * tour.world_from_base.at("b");
  const Pose2 known = answer->reference_from_current * tour.robots.at("b").mapper().pose().map_from_base;
  EXPECT_LT((known.translation() - true_pose.translation()).norm(), 0.12);
  EXPECT_LT(std::abs(wrapAngle(known.yaw_rad - true_pose.yaw_rad)), 0.03);

  const Tour elsewhere = driveThrough(shippedWorld("other_building.yaml"), 2);
  for (const auto& [name, robot] : elsewhere.robots) {
    EXPECT_FALSE(registerRobots(tour.robots.at("a"), robot, {})) << name;
    EXPECT_FALSE(registerRobots(robot, tour.robots.at("b"), {})) << name;
  }
}

TEST(RobotPipeline, BadInputChangesNothing) {
  const RigParams rig;
  RobotPipeline robot(mountingOf(rig), {});
  const cv::Mat1b image(rig.height_px, rig.width_px, uchar(90));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(robot.update({image, image, image}, {nan, 0, 0}), InputError);
  EXPECT_THROW(robot.update({image, cv::Mat1b(60, 80, uchar(90)), image}, {}), InputError);
  EXPECT_THROW(robot.update({}, {}), InputError);
  EXPECT_TRUE(robot.mapper().grid().empty());
}

TEST(RobotPipeline, BlankImagesSayNothing) {
  const RigParams rig;
  RobotPipeline robot(mountingOf(rig), {});
  const cv::Mat1b blank(rig.height_px, rig.width_px, uchar(90));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(robot.update({blank, blank, blank}, {}).inserted);
  EXPECT_TRUE(robot.landmarks().corners.empty());
}

}  // namespace
}  // namespace cornerstone
