// Scans wait here until the odometry of their instant is known, so that no callback blocks on tf and no scan
// enters the map at a wrong pose.
#pragma once

#include <ros/time.h>

#include <deque>
#include <functional>
#include <string>

#include "cornerstone/base/pose2.h"
#include "cornerstone/ros/transforms.h"
#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

struct PendingScan {
  ros::Time stamp;
  RangeScan scan;
};

class PendingScans {
 public:
  PendingScans(double timeout_s, std::function<void(const std::string& cause)> dropped);

  // Scans come in rising order; one that is not newer than the last is dropped and counted.
  void add(PendingScan scan);
  // Hands over, in order, every scan whose odom_from_base is known; drops those that have waited longer than
  // the time-out (measured by the newest stamp and by the clock) or whose pose is not finite.
  void release(const tf2::BufferCore& buffer, const std::string& odom, const std::string& base,
               const std::function<void(const PendingScan&, const Pose2& odom_from_base)>& take);
  // After a jump back in time: everything of the old time goes.
  void clear();
  // True when `stamp` lies so far before the newest one that time itself must have jumped back (a bag that
  // loops).
  bool jumpedBack(const ros::Time& stamp) const;

 private:
  double timeout_s_;
  std::function<void(const std::string&)> dropped_;
  std::deque<PendingScan> waiting_;
  ros::Time newest_;
};

}  // namespace cornerstone
