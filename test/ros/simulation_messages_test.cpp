#include "cornerstone/ros/simulation_messages.h"

#include <gtest/gtest.h>

#include "cornerstone/stereo/trinocular_rig.h"

namespace cornerstone {
namespace {

RobotFrame someFrame() {
  RobotFrame frame;
  frame.robot = "a";
  frame.time_s = 0.1;
  frame.odom_from_base = {1, 2, 0};
  frame.world_from_base = {3, 4, 0};
  for (auto& image : frame.images) image = cv::Mat1b(120, 160, uchar(7));
  return frame;
}

TEST(SimulationMessages, TheShippedConfigurationIsTheDefaultOne) {
  const std::string path = std::string(CORNERSTONE_SOURCE_DIR) + "/config/simulator.yaml";
  const auto shipped = readParams<SimulatorParams>(YAML::LoadFile(path), path);
  const YAML::Node ours = writeParams(SimulatorParams{}), theirs = writeParams(shipped);
  for (const char* key : {"steps_per_second", "steps_per_frame", "supersampling", "seed", "start_s"})
    EXPECT_EQ(ours[key].as<double>(), theirs[key].as<double>()) << key;
  for (const char* group : {"rig", "cameras", "odometry"})
    for (const auto& entry : ours[group])
      EXPECT_NEAR(entry.second.as<double>(), theirs[group][entry.first.as<std::string>()].as<double>(), 0.01)
          << group << "/" << entry.first.as<std::string>();
}

TEST(SimulationMessages, StampsAreWholeNanoseconds) {
  EXPECT_EQ(stampOf(SimulatorParams{}, 0.1).toNSec(), 1000100000000U);
}

TEST(SimulationMessages, FramesAndPosesAreThoseOfTheRobot) {
  const MotionMessages motion = motionMessages(someFrame(), ros::Time(1000, 0));
  EXPECT_EQ(motion.odom_from_base.header.frame_id, "a/odom");
  EXPECT_EQ(motion.odom_from_base.child_frame_id, "a/base_link");
  EXPECT_EQ(motion.odom_from_base.transform.translation.y, 2);
  EXPECT_EQ(motion.ground_truth.header.frame_id, "world");
  EXPECT_EQ(motion.ground_truth.pose.pose.position.x, 3);
}

// f B = 80 px * 0.12 m = 9.6 px m.
TEST(SimulationMessages, CalibrationsDescribeTheL) {
  const auto cameras = cameraMessages(someFrame(), calibrationsOf(RigParams{}), ros::Time(1000, 0));
  ASSERT_EQ(cameras.size(), 3U);
  EXPECT_EQ(cameras[2].image->header.frame_id, "a/reference_optical");
  EXPECT_EQ(cameras[2].image->encoding, "mono8");
  EXPECT_NEAR(cameras[0].info.P[3], 0, 1e-12);
  EXPECT_NEAR(cameras[1].info.P[3], -9.6, 1e-9);
  EXPECT_NEAR(cameras[2].info.P[7], 9.6, 1e-9);
}

TEST(SimulationMessages, ADroppedTripleGivesNoImages) {
  RobotFrame frame = someFrame();
  for (auto& image : frame.images) image.release();
  EXPECT_TRUE(cameraMessages(frame, calibrationsOf(RigParams{}), ros::Time(1000, 0)).empty());
}

}  // namespace
}  // namespace cornerstone
