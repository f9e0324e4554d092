// Messages with ranges wait here until the robot's pose and the sensor's on it are known for their instant,
// so that no callback blocks on tf and no scan enters the map at a wrong pose. Each is turned into a scan
// only then: pitch and roll of the robot belong to it.
#pragma once

#include <ros/time.h>

#include <Eigen/Geometry>
#include <deque>
#include <functional>
#include <string>

#include "cornerstone/base/pose2.h"
#include "cornerstone/ros/transforms.h"
#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

// Where a look was taken.
struct LookPose {
  Pose2 odom_from_base;
  // In the base frame turned level: of the robot's pitch and roll, if its odometry tells them. The floor lies
  // there at z = 0.
  Eigen::Isometry3d level_from_sensor;
};

struct PendingScan {
  ros::Time stamp;
  std::string frame;  // of the sensor
  std::function<RangeScan(const Eigen::Isometry3d& level_from_sensor)> convert;
};

struct LookFrames {
  std::string odom;
  std::string base;
  bool use_tilt = true;  // false: the robot is level whatever odometry says
};

class PendingScans {
 public:
  PendingScans(double timeout_s, std::function<void(const std::string& cause)> dropped);

  // Scans come in rising order; one that is not newer than the last, has no stamp or lies in the future is
  // dropped and counted.
  void add(PendingScan scan);
  // Hands over, in order, every scan whose poses are known; drops those that have waited longer than the
  // time-out (measured by the newest stamp and by the clock), or whose robot lies on its side.
  void release(const tf2::BufferCore& buffer, const LookFrames& frames,
               const std::function<void(const PendingScan&, const LookPose&)>& take);
  // After a jump back in time: everything of the old time goes.
  void clear();
  // True when time itself has jumped back (a bag that loops): `stamp`, of a message that arrives now, lies
  // far before the newest one and so does the clock, or several in a row lie there. A single late message is
  // no jump.
  bool jumpedBack(const ros::Time& stamp);

 private:
  double timeout_s_;
  std::function<void(const std::string&)> dropped_;
  std::deque<PendingScan> waiting_;
  ros::Time newest_;
  int old_in_a_row_ = 0;
};

}  // namespace cornerstone
