// rawlog_to_bag: an MRPT log of a robot with a planar laser as a bag of LaserScan (/ROBOT/scan) and tf
// (ROBOT/odom -> ROBOT/base_link -> ROBOT/laser), so that logs of real buildings run through the nodelets.
// Logs of observations (scans and odometry side by side) and of actions with sensory frames both will do.
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <rosbag/bag.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <limits>

#include "cornerstone/base/errors.h"
#include "tools/program.h"

namespace cornerstone {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CRawlog;

const char* kUsage = "rawlog_to_bag LOG.rawlog --out X.bag [--robot NAME] [--aperture-deg A]";

geometry_msgs::TransformStamped transformOf(const mrpt::poses::CPose3D& pose) {
  mrpt::math::CQuaternionDouble q;
  pose.getAsQuaternion(q);
  geometry_msgs::TransformStamped message;
  message.transform.translation.x = pose.x();
  message.transform.translation.y = pose.y();
  message.transform.translation.z = pose.z();
  message.transform.rotation.w = q.r();
  message.transform.rotation.x = q.x();
  message.transform.rotation.y = q.y();
  message.transform.rotation.z = q.z();
  return message;
}

class Converter {
 public:
  Converter(const Arguments& arguments)
      : robot_(arguments.text("robot", "a")),
        aperture_rad_(arguments.number("aperture-deg", 0) * M_PI / 180),
        bag_(arguments.text("out"), rosbag::bagmode::Write) {}

  void convert(const CRawlog& log) {
    for (std::size_t i = 0; i < log.size(); ++i) {
      if (log.getType(i) == CRawlog::etObservation) {
        take(*log.getAsObservation(i));
      } else if (log.getType(i) == CRawlog::etActionCollection) {
        const auto move = log.getAsAction(i)->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
        if (move) odom_from_base_ = odom_from_base_ + move->rawOdometryIncrementReading;
      } else if (log.getType(i) == CRawlog::etSensoryFrame) {
        for (const auto& observation : *log.getAsObservations(i)) {
          writeOdometry(observation->timestamp);  // the action before led here
          take(*observation);
        }
      }
    }
    bag_.close();
  }
  int scans() const { return scans_; }

 private:
  static ros::Time stampOf(const mrpt::Clock::time_point& time) {
    if (time == INVALID_TIMESTAMP) throw InputError("the log has an observation without a time");
    return ros::Time(mrpt::Clock::toDouble(time));
  }

  void take(const mrpt::obs::CObservation& observation) {
    if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      odom_from_base_ = odometry->odometry;
      writeOdometry(odometry->timestamp);
    } else if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation)) {
      write(*scan);
    }
  }

  void writeOdometry(const mrpt::Clock::time_point& time) {
    tf2_msgs::TFMessage tf;
    tf.transforms = {transformOf(mrpt::poses::CPose3D(odom_from_base_)), transformOf(base_from_laser_)};
    tf.transforms[0].header.frame_id = robot_ + "/odom";
    tf.transforms[0].child_frame_id = tf.transforms[1].header.frame_id = robot_ + "/base_link";
    tf.transforms[1].child_frame_id = robot_ + "/laser";
    for (auto& transform : tf.transforms) transform.header.stamp = stampOf(time);
    bag_.write("/tf", stampOf(time), tf);
  }

  void write(const CObservation2DRangeScan& scan) {
    base_from_laser_ = scan.sensorPose;
    const auto count = scan.getScanSize();
    if (count < 2) throw InputError("the log has a scan of less than two ranges");
    const double aperture_rad = aperture_rad_ > 0 ? aperture_rad_ : static_cast<double>(scan.aperture);
    sensor_msgs::LaserScan message;
    message.header.frame_id = robot_ + "/laser";
    message.header.stamp = stampOf(scan.timestamp);
    message.angle_min = static_cast<float>((scan.rightToLeft ? -0.5 : 0.5) * aperture_rad);
    message.angle_max = -message.angle_min;
    message.angle_increment =
        (message.angle_max - message.angle_min) / (static_cast<float>(count) - 1);  // the ends are beams
    message.range_max = scan.maxRange;
    for (std::size_t i = 0; i < count; ++i)
      message.ranges.push_back(scan.getScanRangeValidity(i) ? scan.getScanRange(i)
                                                            : std::numeric_limits<float>::infinity());
    bag_.write("/" + robot_ + "/scan", message.header.stamp, message);
    ++scans_;
  }

  std::string robot_;
  double aperture_rad_;  // 0: as the log says
  rosbag::Bag bag_;
  mrpt::poses::CPose2D odom_from_base_;
  mrpt::poses::CPose3D base_from_laser_;
  int scans_ = 0;
};

Outcome convert(const Arguments& arguments) {
  if (!arguments.has("out")) throw InputError(std::string("--out is missing; ") + kUsage);
  CRawlog log;
  if (!log.loadFromRawLogFile(arguments.positional(0)))
    throw InputError(arguments.positional(0) + ": no rawlog that can be read");
  Converter converter(arguments);
  converter.convert(log);
  if (converter.scans() == 0) throw InputError(arguments.positional(0) + ": no laser scans in it");
  return {kExitDone, {{"scans", converter.scans()}}};
}

}  // namespace
}  // namespace cornerstone

int main(int argc, char** argv) {
  return cornerstone::runProgram("rawlog_to_bag", [&] {
    return cornerstone::convert(
        cornerstone::Arguments(argc, argv, cornerstone::kUsage, 1, {"out", "robot", "aperture-deg"}));
  });
}
