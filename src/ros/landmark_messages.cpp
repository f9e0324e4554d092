#include "cornerstone/ros/landmark_messages.h"

#include <cmath>
#include <string>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/transforms.h"

namespace cornerstone {
namespace {

using visualization_msgs::Marker;

constexpr double kLineWidth_m =
    0.04;  // thinner than a cell of 0.05 m, still seen in rviz at a building's scale

std_msgs::ColorRGBA colour(float red, float green, float blue) {
  std_msgs::ColorRGBA rgba;
  rgba.r = red;
  rgba.g = green;
  rgba.b = blue;
  rgba.a = 1;
  return rgba;
}

Marker marker(const std_msgs::Header& header, const std::string& ns, int type) {
  Marker shape;
  shape.header = header;
  shape.ns = ns;
  shape.type = type;
  shape.pose.orientation.w = 1;
  shape.scale.x = kLineWidth_m;
  shape.scale.y = kLineWidth_m;
  shape.color = colour(1, 1, 1);
  return shape;
}

geometry_msgs::Point point(const Eigen::Vector2d& place_m, double height_m) {
  geometry_msgs::Point message;
  message.x = place_m.x();
  message.y = place_m.y();
  message.z = height_m;
  return message;
}

std::uint8_t toState(RegistrationState state) {
  switch (state) {
    case RegistrationState::kCandidate:
      return MapRegistration::CANDIDATE;
    case RegistrationState::kRegistered:
      return MapRegistration::REGISTERED;
    case RegistrationState::kLost:
      return MapRegistration::LOST;
    default:
      return MapRegistration::NONE;
  }
}

}  // namespace

Corner toMessage(const CornerLandmark& corner, double now_s) {
  Corner message;
  message.x = corner.pose.x_m;
  message.y = corner.pose.y_m;
  message.yaw = corner.pose.yaw_rad;
  message.covariance = toRowMajor(corner.covariance);
  message.rms = corner.rms_m;
  message.kind = corner.kind == CornerKind::kInsideFree ? Corner::INSIDE_FREE : Corner::INSIDE_SOLID;
  message.id = corner.id;
  message.looks = corner.looks;
  message.age = corner.id != 0 ? now_s - corner.since_s : 0;
  return message;
}

MapRegistration toMessage(const SharedFrame& shared, double now_s) {
  MapRegistration message;
  message.state = toState(shared.state);
  message.reason = shared.reason;
  if (!shared.route || !shared.evidence) return message;
  const FrameRoute& route = *shared.route;
  message.via = route.via;
  message.x = route.reference_from_current.x_m;
  message.y = route.reference_from_current.y_m;
  message.yaw = route.reference_from_current.yaw_rad;
  message.covariance = toRowMajor(route.covariance);
  message.evidence_age = now_s - route.evidence_time_s;
  message.matched = static_cast<unsigned>(shared.evidence->matches.size());
  message.rms = shared.evidence->rms_m;
  message.overlap = shared.evidence->overlap;
  message.second_best = shared.evidence->second_best;
  return message;
}

std::optional<ToldRoute> fromMessage(const MapRegistration& message) {
  if (message.state != MapRegistration::REGISTERED) return std::nullopt;
  ToldRoute told;
  FrameRoute& route = told.route;
  route.reference_from_current = {message.x, message.y, wrapAngle(message.yaw)};
  if (!route.reference_from_current.isFinite()) throw InputError("registration: x, y or yaw is not finite");
  route.covariance =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.covariance.data());
  if (!route.covariance.allFinite() || !(route.covariance.diagonal().minCoeff() >= 0))
    throw InputError("registration: covariance is none");
  route.via = message.via;
  route.evidence_time_s = message.header.stamp.toSec() - message.evidence_age;
  told.robot_epoch = message.current_epoch;
  told.reference_epoch = message.reference_epoch;
  return told;
}

visualization_msgs::MarkerArray toMarkers(const Landmarks& landmarks, double arm_length_m,
                                          const std_msgs::Header& header) {
  Marker edges = marker(header, "edges", Marker::POINTS);
  edges.color = colour(0.2f, 0.8f, 1);
  for (const EdgePoint& edge : landmarks.edges) edges.points.push_back(point(edge.position_m, 0.02));
  Marker arms = marker(header, "corners", Marker::LINE_LIST);
  for (const CornerLandmark& corner : landmarks.corners) {
    const auto shade = corner.kind == CornerKind::kInsideFree ? colour(1, 0.3f, 0) : colour(0.9f, 0, 0.9f);
    for (const Eigen::Vector2d& arm : {Eigen::Vector2d(arm_length_m, 0), Eigen::Vector2d(0, arm_length_m)}) {
      arms.points.push_back(point(corner.pose.translation(), 0.05));
      arms.points.push_back(point(corner.pose * arm, 0.05));
      arms.colors.insert(arms.colors.end(), 2, shade);
    }
  }
  visualization_msgs::MarkerArray markers;
  markers.markers = {edges, arms};
  return markers;
}

visualization_msgs::MarkerArray toMatchMarkers(const MapRegistration& registration) {
  std_msgs::Header header = registration.header;
  header.frame_id = registration.reference_frame;
  Marker lines = marker(header, "matches", Marker::LINE_LIST);
  lines.color = colour(1, 1, 0);
  const Pose2 reference_from_current{registration.x, registration.y, registration.yaw};
  for (std::size_t i = 0; i < registration.reference_corners.size(); ++i) {
    const Corner& reference = registration.reference_corners[i];
    const Corner& current = registration.current_corners[i];
    lines.points.push_back(point({reference.x, reference.y}, 0.1));
    lines.points.push_back(point(reference_from_current * Eigen::Vector2d(current.x, current.y), 0.6));
  }
  visualization_msgs::MarkerArray markers;
  markers.markers = {lines};
  return markers;
}

}  // namespace cornerstone
