#include "cornerstone/ros/pending_scans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace cornerstone {
namespace {

// Scans that wait for odometry at 0.1 s steps, with a clock that stands at the newest stamp.
class PendingScansTest : public ::testing::Test {
 protected:
  PendingScansTest()
      : buffer_(ros::Duration(10)),
        pending_(0.5, [this](const std::string& cause) { dropped_.push_back(cause); }) {
    ros::Time::init();
    geometry_msgs::TransformStamped mounting = toStamped({0.1, 0, 0}, "base", "camera", ros::Time(0));
    mounting.transform.translation.z = 0.4;
    buffer_.setTransform(mounting, "test", true);
  }
  void odometryAt(double time_s, double x_m) {
    buffer_.setTransform(toStamped({x_m, 0, 0}, "odom", "base", ros::Time(time_s)), "test");
  }
  void scanAt(double time_s) {
    ros::Time::setNow(ros::Time(time_s));
    messageAt(time_s);
  }
  void messageAt(double time_s) {
    pending_.add({ros::Time(time_s), "camera", [](const Eigen::Isometry3d&) { return RangeScan{}; }});
  }
  void release() {
    pending_.release(buffer_, {"odom", "base", true}, [this](const PendingScan&, const LookPose& pose) {
      taken_x_m_.push_back(pose.odom_from_base.x_m);
      taken_.push_back(pose);
    });
  }

  tf2::BufferCore buffer_;
  std::vector<std::string> dropped_;
  PendingScans pending_;
  std::vector<double> taken_x_m_;
  std::vector<LookPose> taken_;
};

TEST_F(PendingScansTest, WaitsForTheOdometryOfTheScansInstant) {
  odometryAt(1.0, 0);
  scanAt(1.05);
  release();
  EXPECT_TRUE(taken_x_m_.empty());
  odometryAt(1.1, 1);
  release();
  ASSERT_EQ(taken_x_m_.size(), 1u);
  EXPECT_NEAR(taken_x_m_[0], 0.5, 1e-6);
  EXPECT_TRUE(dropped_.empty());
}

TEST_F(PendingScansTest, DropsWhatHasWaitedTooLongAndGoesOn) {
  odometryAt(1.0, 0);
  scanAt(0.9);  // before all odometry: its pose will never be known
  scanAt(1.0);
  release();
  EXPECT_TRUE(taken_x_m_.empty()) << "order is kept";
  ros::Time::setNow(ros::Time(1.5));
  release();
  ASSERT_EQ(taken_x_m_.size(), 1u);
  ASSERT_EQ(dropped_.size(), 1u);
  EXPECT_NE(dropped_[0].find("odom -> base"), std::string::npos);
}

TEST_F(PendingScansTest, TellsReorderingFromAClockThatJumpedBack) {
  scanAt(100.0);
  messageAt(99.95);
  EXPECT_EQ(dropped_.size(), 1u);
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(99.5)));
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(10.0))) << "one late message";
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(99.9)));
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(10.0)));
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(10.1)));
  EXPECT_TRUE(pending_.jumpedBack(ros::Time(10.2))) << "the third in a row, whatever the clock says";
  ros::Time::setNow(ros::Time(10.0));
  EXPECT_TRUE(pending_.jumpedBack(ros::Time(10.0)));
  pending_.clear();
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(10.0)));
  scanAt(10.0);
  EXPECT_EQ(dropped_.size(), 1u) << "after clear() the clock begins anew";
}

TEST_F(PendingScansTest, StampsThatAreMissingOrInTheFutureAreDroppedAndNothingElse) {
  scanAt(100.0);
  messageAt(0);
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(0)));
  ASSERT_EQ(dropped_.size(), 1u);
  EXPECT_NE(dropped_[0].find("without a stamp"), std::string::npos);
  messageAt(4000);
  ASSERT_EQ(dropped_.size(), 2u);
  EXPECT_NE(dropped_[1].find("future"), std::string::npos);
  scanAt(100.1);  // the next one is in order all the same
  EXPECT_EQ(dropped_.size(), 2u);
}

// A robot that heads left and pitches 3 degrees down about its own side axis; its camera is 0.4 m up.
TEST_F(PendingScansTest, PitchAndRollOfTheRobotBelongToTheSensorsPose) {
  const double pitch_rad = 3 * M_PI / 180;
  geometry_msgs::TransformStamped odometry = toStamped({1, 2, 0}, "odom", "base", ros::Time(5));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
  odometry.transform.rotation.x = turn.x();
  odometry.transform.rotation.y = turn.y();
  odometry.transform.rotation.z = turn.z();
  odometry.transform.rotation.w = turn.w();
  odometry.transform.translation.z = 7;  // visual odometry's height drifts
  buffer_.setTransform(odometry, "test");
  scanAt(5);
  release();
  ASSERT_EQ(taken_.size(), 1u);
  EXPECT_NEAR(taken_[0].odom_from_base.yaw_rad, M_PI / 2, 1e-6);
  const Eigen::Isometry3d& level = taken_[0].level_from_sensor;
  EXPECT_NEAR(level.translation().x(), 0.1 * std::cos(pitch_rad) + 0.4 * std::sin(pitch_rad), 1e-6);
  EXPECT_NEAR(level.translation().z(), 0.4 * std::cos(pitch_rad) - 0.1 * std::sin(pitch_rad), 1e-6);
  EXPECT_NEAR(level.linear()(2, 0), -std::sin(pitch_rad), 1e-6);  // its x axis points to the floor
  EXPECT_NEAR(level.linear()(1, 0), 0, 1e-6);
}

TEST_F(PendingScansTest, ARobotOnItsSideMapsNothing) {
  geometry_msgs::TransformStamped odometry = toStamped({1, 2, 0}, "odom", "base", ros::Time(5));
  odometry.transform.rotation.x = std::sin(M_PI / 4);
  odometry.transform.rotation.w = std::cos(M_PI / 4);
  buffer_.setTransform(odometry, "test");
  scanAt(5);
  release();
  EXPECT_TRUE(taken_.empty());
  ASSERT_EQ(dropped_.size(), 1u);
  EXPECT_NE(dropped_[0].find("side"), std::string::npos);
}

// A camera on a turning head: its pose is that of the scan's instant, not the newest.
TEST_F(PendingScansTest, AMovingMountIsLookedUpAtTheScansInstant) {
  odometryAt(1.0, 0);
  odometryAt(2.0, 0);
  buffer_.setTransform(toStamped({0, 0, 0}, "base", "head", ros::Time(1)), "test");
  ros::Time::setNow(ros::Time(1.5));
  pending_.add({ros::Time(1.5), "head", [](const Eigen::Isometry3d&) { return RangeScan{}; }});
  release();
  EXPECT_TRUE(taken_.empty()) << "not known yet";
  buffer_.setTransform(toStamped({0, 0, 1}, "base", "head", ros::Time(2)), "test");
  release();
  ASSERT_EQ(taken_.size(), 1u);
  EXPECT_NEAR(planarPart(taken_[0].level_from_sensor).yaw_rad, 0.5, 1e-6);
}

}  // namespace
}  // namespace cornerstone
