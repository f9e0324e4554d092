#include "cornerstone/registration/frame_smoother.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {

Pose2 between(const Pose2& from, const Pose2& to, const Eigen::Vector2d& centre_m, double share) {
  Pose2 pose;
  pose.yaw_rad = wrapAngle(from.yaw_rad + share * wrapAngle(to.yaw_rad - from.yaw_rad));
  const Eigen::Vector2d middle = (1 - share) * (from * centre_m) + share * (to * centre_m);
  const Eigen::Vector2d origin = middle - pose.rotation() * centre_m;
  pose.x_m = origin.x();
  pose.y_m = origin.y();
  return pose;
}

Pose2 FrameSmoother::follow(const Pose2& reference_from_current, const Eigen::Vector2d& centre_m,
                            double time_s) {
  const double elapsed_s = std::max(time_s - time_s_, 0.0);
  time_s_ = time_s;
  const double share = time_constant_s_ > 0 ? 1 - std::exp(-elapsed_s / time_constant_s_) : 1;
  shown_ = shown_ ? between(*shown_, reference_from_current, centre_m, share) : reference_from_current;
  return *shown_;
}

}  // namespace cornerstone
