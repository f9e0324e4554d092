#include "cornerstone/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/stereo/trinocular_rig.h"

namespace cornerstone {
namespace {

const char* kRoom = R"(
name: room
seed: 3
extent_m: [-3, -3, 3, 3]
ceiling_m: 2.5
walls:
  - {points_m: [[-2, -2], [2, -2], [2, 2], [-2, 2]], closed: true, height_m: 2.5, thickness_m: 0.1, material: plaster}
robots:
  - {name: a, start_m_m_deg: [-1, 0, 0], speed_m_s: 0.5, turn_rate_deg_s: 45, route: [{to_m: [0, 0]}]}
  - {name: b, start_m_m_deg: [1, 1, 90], speed_m_s: 0.5, turn_rate_deg_s: 45, route: [{turn_deg: 45}]}
)";

World room() { return parseWorld(kRoom, "room", "."); }

struct Drive {
  std::vector<std::vector<RobotFrame>> frames;
};

Drive driveOf(const SimulationParams& params, int frames) {
  Simulation simulation(room(), params);
  Drive run;
  while (int(run.frames.size()) < frames) {
    if (simulation.frameDue()) run.frames.push_back(simulation.frames());
    simulation.step();
  }
  return run;
}

// The largest difference of two runs' images and odometry.
double difference(const Drive& one, const Drive& two) {
  double largest = 0;
  for (std::size_t i = 0; i < one.frames.size(); ++i) {
    for (std::size_t r = 0; r < one.frames[i].size(); ++r) {
      const RobotFrame &a = one.frames[i][r], &b = two.frames[i][r];
      for (std::size_t c = 0; c < kCameraCount; ++c)
        largest = std::max(largest, cv::norm(a.images[c], b.images[c], cv::NORM_INF));
      largest = std::max(largest, std::abs(a.odom_from_base.x_m - b.odom_from_base.x_m));
    }
  }
  return largest;
}

TEST(Simulation, SameSeedSameOutput) {
  SimulationParams params;
  const Drive first = driveOf(params, 4);
  EXPECT_EQ(difference(first, driveOf(params, 4)), 0);
  params.seed = 2;
  EXPECT_GT(difference(first, driveOf(params, 4)), 5);
}

TEST(Simulation, DrivesItsRoutesWithoutTouching) {
  Simulation simulation(room(), {});
  while (!simulation.routesDone() && simulation.time_s() < 20) simulation.step();
  EXPECT_TRUE(simulation.routesDone());
  const auto frames = simulation.frames(false);
  EXPECT_NEAR(frames[0].world_from_base.x_m, 0, 0.1);
  EXPECT_NEAR(frames[1].world_from_base.yaw_rad, 3 * M_PI / 4, 0.05);
  EXPECT_EQ(frames[0].collisions, 0);
  EXPECT_TRUE(frames[0].images[0].empty());
}

TEST(Simulation, ACommandedRobotStopsAtTheWallAndCountsTheTouchOnce) {
  SimulationParams params;
  params.follow_routes = false;
  params.robots = {"a"};
  Simulation simulation(room(), params);
  for (int i = 0; i < 300; ++i) {
    simulation.command("a", {1, 0});
    simulation.step();
  }
  const auto frames = simulation.frames(false);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].collisions, 1);
  // The wall's face is at 1.95 m, the robot's radius 0.2 m.
  EXPECT_NEAR(frames[0].world_from_base.x_m, 1.75, 0.03);
  EXPECT_THROW(simulation.command("a", {std::nan(""), 0}), InputError);
}

TEST(Simulation, FramesAreDroppedAtRandom) {
  SimulationParams params;
  params.supersampling = 1;
  params.cameras.dropped_share = 0.5;
  int dropped = 0;
  for (const auto& frames : driveOf(params, 40).frames) dropped += int(frames[0].images[0].empty());
  EXPECT_NEAR(dropped, 20, 12);
}

TEST(Simulation, FaultsAreWhatTheirParametersSay) {
  CameraFaultParams params;
  params.noise_grey = 3;
  params.gain_difference = 0;
  params.rectification_error_px = 0;
  CameraFaults faults(params, 80, 1);
  const cv::Mat1f grey(120, 160, 100.F);
  cv::Scalar mean, spread;
  cv::meanStdDev(faults.expose(grey, 1), mean, spread);
  EXPECT_NEAR(mean[0], 100, 0.2);
  EXPECT_NEAR(spread[0], 3, 0.1);
  EXPECT_NEAR((faults.misalignment(2) - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
}

TEST(Simulation, RefusesWhatCannotBe) {
  SimulationParams params;
  params.robots = {"nobody"};
  EXPECT_THROW(Simulation(room(), params), InputError);
  params = {};
  params.rig.baseline_m = -0.1;
  EXPECT_THROW(Simulation(room(), params), InputError);
  params = {};
  params.vehicle.radius_m = 1.0;  // reaches the wall from its start
  EXPECT_THROW(Simulation(room(), params), InputError);
}

}  // namespace
}  // namespace cornerstone
