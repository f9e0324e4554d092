#include "cornerstone/registration/frame_route.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

constexpr double kSigmas = 3;

// Variance of the place, in the reference map, of a point of the current one.
double placeVariance(const FrameRoute& route, const Eigen::Vector2d& at_m) {
  const Eigen::Vector2d arm = route.reference_from_current.rotation() * at_m;
  Eigen::Matrix<double, 2, 3> by_pose;  // d(point) / d(x, y, yaw)
  by_pose << 1, 0, -arm.y(), 0, 1, arm.x();
  return (by_pose * route.covariance * by_pose.transpose()).trace();
}

std::string nameOf(const FrameRoute& route) {
  if (route.via.empty()) return "the direct one";
  std::string name = "that through ";
  for (std::size_t i = 0; i < route.via.size(); ++i) name += (i > 0 ? ", " : "") + route.via[i];
  return name;
}

}  // namespace

FrameRoute throughRobot(const FrameRoute& reference_from_other, const std::string& other,
                        const FrameRoute& other_from_current) {
  FrameRoute route;
  route.reference_from_current =
      reference_from_other.reference_from_current * other_from_current.reference_from_current;
  route.covariance =
      composeCovariance(reference_from_other.reference_from_current, reference_from_other.covariance,
                        other_from_current.reference_from_current, other_from_current.covariance);
  route.via = reference_from_other.via;
  route.via.push_back(other);
  route.evidence_time_s = std::min(reference_from_other.evidence_time_s, other_from_current.evidence_time_s);
  return route;
}

bool agree(const FrameRoute& one, const FrameRoute& other, const RouteAgreement& limits) {
  const Eigen::Vector2d& at_m = limits.at_in_current_m;
  const double apart_m = (one.reference_from_current * at_m - other.reference_from_current * at_m).norm();
  const double turned_rad =
      std::abs(wrapAngle(one.reference_from_current.yaw_rad - other.reference_from_current.yaw_rad));
  const double sigma_m = std::sqrt(placeVariance(one, at_m) + placeVariance(other, at_m));
  const double sigma_rad = std::sqrt(one.covariance(2, 2) + other.covariance(2, 2));
  return apart_m <= limits.distance_m + kSigmas * sigma_m &&
         turned_rad <= limits.angle_rad + kSigmas * sigma_rad;
}

RouteChoice chooseRoute(const std::vector<FrameRoute>& routes, const RouteAgreement& limits) {
  if (routes.empty()) return {};
  for (std::size_t i = 0; i < routes.size(); ++i)
    for (std::size_t j = i + 1; j < routes.size(); ++j)
      if (!agree(routes[i], routes[j], limits))
        return {{},
                "two ways to the reference map contradict each other: " + nameOf(routes[i]) + " and " +
                    nameOf(routes[j])};
  const auto better = [&](const FrameRoute& a, const FrameRoute& b) {
    if (a.via.size() != b.via.size()) return a.via.size() < b.via.size();
    return placeVariance(a, limits.at_in_current_m) < placeVariance(b, limits.at_in_current_m);
  };
  return {*std::min_element(routes.begin(), routes.end(), better), ""};
}

}  // namespace cornerstone
