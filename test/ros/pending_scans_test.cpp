#include "cornerstone/ros/pending_scans.h"

#include <gtest/gtest.h>

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
  }
  void odometryAt(double time_s, double x_m) {
    buffer_.setTransform(toStamped({x_m, 0, 0}, "odom", "base", ros::Time(time_s)), "test");
  }
  void scanAt(double time_s) {
    ros::Time::setNow(ros::Time(time_s));
    pending_.add({ros::Time(time_s), RangeScan{}});
  }
  void release() {
    pending_.release(buffer_, "odom", "base",
                     [this](const PendingScan&, const Pose2& pose) { taken_x_m_.push_back(pose.x_m); });
  }

  tf2::BufferCore buffer_;
  std::vector<std::string> dropped_;
  PendingScans pending_;
  std::vector<double> taken_x_m_;
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
  pending_.add({ros::Time(99.95), RangeScan{}});
  EXPECT_EQ(dropped_.size(), 1u);
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(99.5)));
  EXPECT_TRUE(pending_.jumpedBack(ros::Time(10.0)));
  pending_.clear();
  EXPECT_FALSE(pending_.jumpedBack(ros::Time(10.0)));
  scanAt(10.0);
  EXPECT_EQ(dropped_.size(), 1u) << "after clear() the clock begins anew";
}

}  // namespace
}  // namespace cornerstone
