// A robot driven along waypoints with odometry that drifts: what mapping has to live with.
#pragma once

#include <random>
#include <vector>

#include "cornerstone/base/pose2.h"

namespace cornerstone::test {

struct TourParams {
  double speed_m_s = 1.0;
  double turn_rad_s = 1.5;
  double rate_hz = 10;
  double scale_error = 0.03;                    // of the distance, systematic
  double yaw_drift_rad_per_m = 2 * M_PI / 180;  // systematic
  double noise_m_per_sqrt_m = 0.01;
  double noise_rad_per_sqrt_m = 0.01;
};

struct TourStep {
  Pose2 map_from_base;   // truth
  Pose2 odom_from_base;  // drifted
};

// Turns on the spot to each waypoint, then drives to it.
inline std::vector<TourStep> driveTour(const std::vector<Eigen::Vector2d>& waypoints_m,
                                       const TourParams& params, std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::vector<TourStep> steps;
  const Eigen::Vector2d first = waypoints_m[1] - waypoints_m[0];
  TourStep now{{waypoints_m[0].x(), waypoints_m[0].y(), std::atan2(first.y(), first.x())}, {}};
  steps.push_back(now);
  const auto move = [&](double driven_m, double turned_rad) {
    now.map_from_base = now.map_from_base * Pose2{driven_m, 0, turned_rad};
    const double root = std::sqrt(driven_m);
    now.odom_from_base =
        now.odom_from_base *
        Pose2{driven_m * (1 + params.scale_error) + gauss(random) * params.noise_m_per_sqrt_m * root, 0,
              turned_rad * (1 + params.scale_error) + driven_m * params.yaw_drift_rad_per_m +
                  gauss(random) * params.noise_rad_per_sqrt_m * root};
    steps.push_back(now);
  };
  for (std::size_t i = 1; i < waypoints_m.size(); ++i) {
    const Eigen::Vector2d to = waypoints_m[i] - now.map_from_base.translation();
    const double turn_rad = wrapAngle(std::atan2(to.y(), to.x()) - now.map_from_base.yaw_rad);
    const int turns = static_cast<int>(std::ceil(std::abs(turn_rad) * params.rate_hz / params.turn_rad_s));
    for (int k = 0; k < turns; ++k) move(0, turn_rad / turns);
    const int drives = static_cast<int>(std::ceil(to.norm() * params.rate_hz / params.speed_m_s));
    for (int k = 0; k < drives; ++k) move(to.norm() / drives, 0);
  }
  return steps;
}

// Through both rooms and the corridor of officeRoom(), about 40 m.
inline std::vector<Eigen::Vector2d> officeTour() {
  return {{3, 2},     {3, 4.8},  {7.5, 4.8}, {7.5, 2.5}, {10, 1.5},  {7.2, 1.7}, {4, 1.7},
          {3, 3},     {3, 4.8},  {4.5, 4.8}, {4.5, 7},   {5.8, 7.5}, {8, 7.5},   {9.5, 7},
          {9.5, 4.8}, {11, 4.8}, {1.5, 4.8}, {3, 4.8},   {3, 2}};
}

}  // namespace cornerstone::test
