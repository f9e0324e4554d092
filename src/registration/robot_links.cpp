#include "cornerstone/registration/robot_links.h"

#include <algorithm>
#include <utility>

namespace cornerstone {
namespace {

FrameRoute directRoute(const RegistrationTracker& tracker, double time_s) {
  return {
      tracker.estimate()->reference_from_current, tracker.covarianceAt(time_s), {}, tracker.evidenceTime()};
}

bool isRegistered(const RegistrationTracker& tracker) {
  return tracker.state() == RegistrationState::kRegistered;
}

}  // namespace

RobotLinks::RobotLinks(std::string self, std::string reference, const std::vector<std::string>& others,
                       const TrackerParams& params)
    : self_(std::move(self)), reference_(std::move(reference)), params_(params) {
  if (!reference_.empty() && reference_ != self_)
    links_.emplace(reference_, Link{RegistrationTracker(params), {}, {}});
  for (const std::string& other : others) links_.emplace(other, Link{RegistrationTracker(params), {}, {}});
}

bool RobotLinks::update(const std::string& robot, const std::optional<Registration>& answer,
                        const Eigen::Vector2d& centre_m, double time_s) {
  return links_.at(robot).tracker.update(answer, centre_m, time_s);
}

void RobotLinks::beginAnew(const std::string& robot, std::uint32_t epoch) {
  Link& link = links_.at(robot);
  if (link.epoch && *link.epoch != epoch) link.tracker.lose(robot + ": the map began anew");
  link.epoch = epoch;
}

void RobotLinks::beginAnew(const std::string& reason) {
  for (auto& [robot, link] : links_) link.tracker.lose(reason);
}

void RobotLinks::hear(const std::string& robot, const std::optional<ToldRoute>& told) {
  Link& link = links_.at(robot);
  link.told = told;
  if (told && std::count(told->route.via.begin(), told->route.via.end(), self_) > 0) link.told.reset();
}

std::optional<FrameRoute> RobotLinks::routeOf(const std::string& robot) const {
  if (robot == reference_) return FrameRoute{};
  const Link& link = links_.at(robot);
  if (!link.told || link.epoch != link.told->robot_epoch) return std::nullopt;
  // The reference robot itself does not follow its own map here.
  const auto reference = links_.find(reference_);
  if (reference != links_.end() && reference->second.epoch != link.told->reference_epoch) return std::nullopt;
  return link.told->route;
}

std::optional<Pose2> RobotLinks::priorFor(const std::string& robot, const SharedFrame& shared) const {
  const Link& link = links_.at(robot);
  if (isRegistered(link.tracker)) return link.tracker.estimate()->reference_from_current;
  const auto reference_from_robot = routeOf(robot);
  if (shared.state != RegistrationState::kRegistered || !reference_from_robot) return std::nullopt;
  return reference_from_robot->reference_from_current.inverse() * shared.route->reference_from_current;
}

std::vector<FrameRoute> RobotLinks::routesAt(double time_s) const {
  std::vector<FrameRoute> routes;
  for (const auto& [robot, link] : links_) {
    if (!isRegistered(link.tracker)) continue;
    const FrameRoute direct = directRoute(link.tracker, time_s);
    if (robot == reference_) {
      routes.push_back(direct);
    } else if (const auto reference_from_robot = routeOf(robot)) {
      routes.push_back(throughRobot(*reference_from_robot, robot, direct));
    }
  }
  return routes;
}

SharedFrame RobotLinks::withoutRoute(const std::string& refusal, double time_s) const {
  const auto direct = links_.find(reference_);
  if (direct == links_.end()) return {};
  const RegistrationTracker& tracker = direct->second.tracker;
  SharedFrame shared{tracker.state(), tracker.reason(), {}, {}};
  if (!refusal.empty()) return {RegistrationState::kLost, refusal, {}, {}};
  if (tracker.state() == RegistrationState::kCandidate) {
    shared.route = directRoute(tracker, time_s);
    shared.evidence = tracker.estimate();
  } else if (was_registered_ && tracker.state() != RegistrationState::kLost) {
    shared.state = RegistrationState::kLost;
    shared.reason = "the robots in between no longer lead to the reference map";
  }
  return shared;
}

SharedFrame RobotLinks::shared(const Eigen::Vector2d& centre_m, double time_s) {
  const RouteChoice choice =
      chooseRoute(routesAt(time_s), {centre_m, params_.agree_distance_m, params_.agree_angle_rad});
  if (!choice.route) {
    const SharedFrame none = withoutRoute(choice.refusal, time_s);
    was_registered_ = none.state == RegistrationState::kLost;
    return none;
  }
  was_registered_ = true;
  const std::string& neighbour = choice.route->via.empty() ? reference_ : choice.route->via.back();
  return {RegistrationState::kRegistered, "", choice.route, links_.at(neighbour).tracker.estimate()};
}

}  // namespace cornerstone
