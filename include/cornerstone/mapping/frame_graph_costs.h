// Ceres costs of the frame graph. Poses are (x_m, y_m, yaw_rad) of map_from_base.
#pragma once

#include <ceres/jet.h>

#include <cmath>

#include "cornerstone/mapping/frame_match.h"

namespace cornerstone {

// later in the frame of earlier, less `expected`; the yaw wrapped.
template <typename T>
void relativeTo(const Pose2& expected, const T* earlier, const T* later, T* difference) {
  using std::atan2;
  using std::cos;
  using std::sin;
  const T c = cos(earlier[2]), s = sin(earlier[2]);
  const T dx = later[0] - earlier[0], dy = later[1] - earlier[1];
  difference[0] = c * dx + s * dy - expected.x_m;
  difference[1] = c * dy - s * dx - expected.y_m;
  const T turn = later[2] - earlier[2] - expected.yaw_rad;
  difference[2] = atan2(sin(turn), cos(turn));
}

// r = U (later in earlier - z, c) + u     (frame_match.h)
class FrameMatchCost {
 public:
  explicit FrameMatchCost(const FrameMatch& match) : match_(match) {}
  template <typename T>
  bool operator()(const T* earlier, const T* later, const T* calibration, T* residuals) const {
    T all[5];
    relativeTo(match_.earlier_from_later, earlier, later, all);
    all[3] = calibration[0];
    all[4] = calibration[1];
    for (int i = 0; i < 5; ++i) {
      residuals[i] = T(match_.offset(i));
      for (int j = 0; j < 5; ++j) residuals[i] += match_.sqrt_information(i, j) * all[j];
    }
    return true;
  }

 private:
  FrameMatch match_;
};

// The step that odometry reports, less its systematic drift (odometry_filter.h): rates are scale, yaw per
// metre in rad/m, scale of turns. Heading is lost evenly along the step, so that its direction is off by half
// of what is lost.
class OdometryStepCost {
 public:
  OdometryStepCost(const Pose2& step, const Eigen::Vector3d& sigmas) : step_(step), sigmas_(sigmas) {}
  template <typename T>
  bool operator()(const T* earlier, const T* later, const T* rates, T* residuals) const {
    using std::cos;
    using std::sin;
    relativeTo(Pose2{}, earlier, later, residuals);
    const T drift = rates[1] * step_.x_m + rates[2] * step_.yaw_rad;
    const T c = (1.0 - rates[0]) * cos(0.5 * drift), s = (1.0 - rates[0]) * sin(0.5 * drift);
    residuals[0] = (residuals[0] - (c * step_.x_m + s * step_.y_m)) / sigmas_.x();
    residuals[1] = (residuals[1] - (c * step_.y_m - s * step_.x_m)) / sigmas_.y();
    residuals[2] = (residuals[2] - step_.yaw_rad + drift) / sigmas_.z();
    return true;
  }

 private:
  Pose2 step_;
  Eigen::Vector3d sigmas_;
};

// r = value / sigma, each: what is known before any look.
template <int kSize>
class ZeroPriorCost {
 public:
  explicit ZeroPriorCost(const Eigen::Matrix<double, kSize, 1>& sigmas) : sigmas_(sigmas) {}
  template <typename T>
  bool operator()(const T* values, T* residuals) const {
    for (int i = 0; i < kSize; ++i) residuals[i] = values[i] / sigmas_(i);
    return true;
  }

 private:
  Eigen::Matrix<double, kSize, 1> sigmas_;
};

}  // namespace cornerstone
