// Ceres cost of a pose: distance of a beam's end to the line of the map's surface beside it, over its sigma.
//   r = n . (R(yaw) p + t - m) / sigma      p: end of the beam in the base frame, m and n: point and normal
//   in the map
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <cmath>

namespace cornerstone {

struct LineMatch {
  Eigen::Vector2d point_in_base_m;
  Eigen::Vector2d surface_m;
  Eigen::Vector2d normal;  // unit length
  double sigma_m = 1;
};

class PointToLineCost {
 public:
  explicit PointToLineCost(const LineMatch& match) : match_(match) {}
  // pose: x_m, y_m, yaw_rad of map_from_base
  template <typename T>
  bool operator()(const T* pose, T* residual) const {
    using std::cos;
    using std::sin;
    const T c = cos(pose[2]), s = sin(pose[2]);
    const T x =
        c * match_.point_in_base_m.x() - s * match_.point_in_base_m.y() + pose[0] - match_.surface_m.x();
    const T y =
        s * match_.point_in_base_m.x() + c * match_.point_in_base_m.y() + pose[1] - match_.surface_m.y();
    residual[0] = (match_.normal.x() * x + match_.normal.y() * y) / match_.sigma_m;
    return true;
  }

 private:
  LineMatch match_;
};

// Ceres cost that holds a pose to where odometry expects it: r = W (pose - expected), yaw difference not
// wrapped, so the caller keeps both within one turn.
class PosePriorCost {
 public:
  PosePriorCost(const Eigen::Vector3d& expected, const Eigen::Matrix3d& sqrt_information)
      : expected_(expected), sqrt_information_(sqrt_information) {}
  template <typename T>
  bool operator()(const T* pose, T* residuals) const {
    for (int i = 0; i < 3; ++i) {
      residuals[i] = T(0);
      for (int j = 0; j < 3; ++j) residuals[i] += sqrt_information_(i, j) * (pose[j] - expected_(j));
    }
    return true;
  }

 private:
  Eigen::Vector3d expected_;
  Eigen::Matrix3d sqrt_information_;
};

}  // namespace cornerstone
