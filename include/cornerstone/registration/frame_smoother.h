// What the shared frame shows between answers: it glides to the newest estimate instead of jumping there.
// Metres, radians, seconds of any rising clock. The first pose after a reset is shown as it is.
#pragma once

#include <optional>

#include "cornerstone/base/pose2.h"

namespace cornerstone {

class FrameSmoother {
 public:
  // time_constant_s: after so long 63 % of a step are done; 0: no smoothing.
  explicit FrameSmoother(double time_constant_s) : time_constant_s_(time_constant_s) {}

  // The pose to show. centre_m: the point of the current map that moves on a straight line (where the robot
  // is, or the map's middle), however far the map's origin lies.
  Pose2 follow(const Pose2& reference_from_current, const Eigen::Vector2d& centre_m, double time_s);
  void reset() { shown_.reset(); }

 private:
  double time_constant_s_;
  std::optional<Pose2> shown_;
  double time_s_ = 0;
};

// A share of the way from one pose to another, the centre on a straight line.
Pose2 between(const Pose2& from, const Pose2& to, const Eigen::Vector2d& centre_m, double share);

}  // namespace cornerstone
