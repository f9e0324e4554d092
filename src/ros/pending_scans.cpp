#include "cornerstone/ros/pending_scans.h"

#include <cmath>
#include <utility>

namespace cornerstone {
namespace {

// Cameras and networks reorder by fractions of a second; a second back is another run of the clock, a second
// ahead a clock that was never set.
constexpr double kJump_s = 1.0;
constexpr int kOldInARow = 3;               // of one old message there may be two copies
constexpr double kMostTilt_rad = M_PI / 6;  // a robot that drives tilts less; one that fell maps nothing

}  // namespace

PendingScans::PendingScans(double timeout_s, std::function<void(const std::string&)> dropped)
    : timeout_s_(timeout_s), dropped_(std::move(dropped)) {}

bool PendingScans::jumpedBack(const ros::Time& stamp) {
  const bool old = !stamp.isZero() && !newest_.isZero() && (newest_ - stamp).toSec() > kJump_s;
  old_in_a_row_ = old ? old_in_a_row_ + 1 : 0;
  return old && ((newest_ - ros::Time::now()).toSec() > kJump_s || old_in_a_row_ >= kOldInARow);
}

void PendingScans::clear() {
  waiting_.clear();
  newest_ = ros::Time();
  old_in_a_row_ = 0;
}

void PendingScans::add(PendingScan scan) {
  const ros::Time now = ros::Time::now();
  if (scan.stamp.isZero()) {  // tf would take it for "the newest"
    dropped_("a scan without a stamp");
  } else if (!now.isZero() && (scan.stamp - now).toSec() > kJump_s) {
    dropped_("a scan from the future: clocks differ");
  } else if (scan.stamp <= newest_) {
    dropped_("a scan out of order");
  } else {
    newest_ = scan.stamp;
    waiting_.push_back(std::move(scan));
  }
}

void PendingScans::release(const tf2::BufferCore& buffer, const LookFrames& frames,
                           const std::function<void(const PendingScan&, const LookPose&)>& take) {
  while (!waiting_.empty()) {
    const PendingScan& first = waiting_.front();
    const auto odom_from_base = lookUp(buffer, frames.odom, frames.base, first.stamp);
    const auto base_from_sensor = lookUp(buffer, frames.base, first.frame, first.stamp);
    const bool late =
        (newest_ - first.stamp).toSec() > timeout_s_ || (ros::Time::now() - first.stamp).toSec() > timeout_s_;
    if (odom_from_base && base_from_sensor) {
      const Eigen::Isometry3d level_from_base = tiltOf(*odom_from_base);
      if (level_from_base.linear()(2, 2) < std::cos(kMostTilt_rad))
        dropped_("odometry says that the robot lies on its side");
      else
        take(first, {planarPart(*odom_from_base),
                     frames.use_tilt ? level_from_base * *base_from_sensor : *base_from_sensor});
    } else if (late) {
      dropped_(odom_from_base ? "no tf " + frames.base + " -> " + first.frame + " at the scan's stamp"
                              : "no tf " + frames.odom + " -> " + frames.base + " at the scan's stamp");
    } else {
      return;
    }
    waiting_.pop_front();
  }
}

}  // namespace cornerstone
