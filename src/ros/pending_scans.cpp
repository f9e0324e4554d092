#include "cornerstone/ros/pending_scans.h"

#include <utility>

namespace cornerstone {
namespace {

// Cameras and networks reorder by fractions of a second; a second back is another run of the clock.
constexpr double kJump_s = 1.0;

}  // namespace

PendingScans::PendingScans(double timeout_s, std::function<void(const std::string&)> dropped)
    : timeout_s_(timeout_s), dropped_(std::move(dropped)) {}

bool PendingScans::jumpedBack(const ros::Time& stamp) const {
  return !newest_.isZero() && (newest_ - stamp).toSec() > kJump_s;
}

void PendingScans::clear() {
  waiting_.clear();
  newest_ = ros::Time();
}

void PendingScans::add(PendingScan scan) {
  if (scan.stamp <= newest_) {
    dropped_("a scan out of order");
    return;
  }
  newest_ = scan.stamp;
  waiting_.push_back(std::move(scan));
}

void PendingScans::release(const tf2::BufferCore& buffer, const std::string& odom, const std::string& base,
                           const std::function<void(const PendingScan&, const Pose2&)>& take) {
  while (!waiting_.empty()) {
    const PendingScan& first = waiting_.front();
    if (const auto odom_from_base = lookUp(buffer, odom, base, first.stamp)) {
      take(first, planarPart(*odom_from_base));
    } else if ((newest_ - first.stamp).toSec() > timeout_s_ ||
               (ros::Time::now() - first.stamp).toSec() > timeout_s_) {
      dropped_("no tf " + odom + " -> " + base + " at the scan's stamp");
    } else {
      return;
    }
    waiting_.pop_front();
  }
}

}  // namespace cornerstone
