// The pose of this robot's map in the reference robot's map, found directly or through robots in between:
// a_from_c = a_from_b * b_from_c. Metres, radians, covariances (x, y, yaw).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cornerstone/base/pose2.h"

namespace cornerstone {

struct FrameRoute {
  Pose2 reference_from_current;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<std::string> via;  // robots in between, the reference robot's neighbour first; empty: direct
  double evidence_time_s = 0;    // of the oldest of its links
};

// The route of a robot that is registered to `other`, which has a route of its own. Links are independent:
// each rests on another pair of maps.
FrameRoute throughRobot(const FrameRoute& reference_from_other, const std::string& other,
                        const FrameRoute& other_from_current);

// Two routes to one frame must tell the same: at a point of the current map, to this distance and angle
// beyond three standard deviations of both.
struct RouteAgreement {
  Eigen::Vector2d at_in_current_m;
  double distance_m;
  double angle_rad;
};
bool agree(const FrameRoute& one, const FrameRoute& other, const RouteAgreement& limits);

// The route with the fewest robots in between, of these the surest. None, with the reason, where two routes
// contradict each other: one of them is wrong, and nothing tells which.
struct RouteChoice {
  std::optional<FrameRoute> route;
  std::string refusal;
};
RouteChoice chooseRoute(const std::vector<FrameRoute>& routes, const RouteAgreement& limits);

}  // namespace cornerstone
