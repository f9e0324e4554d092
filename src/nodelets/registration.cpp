// This robot's landmarks, and the pose of its map in the reference robot's map. Takes map_tiles of this and
// of the other robots, and their registration; gives landmarks, landmark_markers, registration,
// match_markers, merged_map, the service align and, while registered, the tf between the maps.
#include <ros/callback_queue.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "cornerstone/base/errors.h"
#include "cornerstone/registration/frame_smoother.h"
#include "cornerstone/ros/align_service.h"
#include "cornerstone/ros/diagnostics.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/ros/transforms.h"
#include "nodelets/factories.h"
#include "nodelets/followed_robots.h"
#include "nodelets/nodelet_start.h"
#include "nodelets/registration_topics.h"

namespace cornerstone {
namespace {

void requireUsable(const RegistrationNodeletParams& params) {
  requirePositive(params.period_s, "parameter 'period_s'");
  requirePositive(params.tf_period_s, "parameter 'tf_period_s'");
  requireWithin(params.registration.robot_radius_m, 0, 2, "parameter 'registration/robot_radius_m'");
  const std::vector<std::string>& others = params.other_robots;
  for (const std::string& other : others)
    if (other.empty() || other == params.robot || other == params.reference_robot ||
        std::count(others.begin(), others.end(), other) > 1)
      throw InputError("parameter 'other_robots': '" + other +
                       "' is empty, named twice, this robot or the reference robot");
}

}  // namespace

class RegistrationNodelet : public nodelet::Nodelet {
 public:
  ~RegistrationNodelet() override {
    if (slow_spinner_) slow_spinner_->stop();
  }

 private:
  void onInit() override {
    startOrRefuse(getName(), [this] { start(); });
  }

  void start() {
    ros::NodeHandle& node = getNodeHandle();
    params_ = loadParams<RegistrationNodeletParams>(getPrivateNodeHandle());
    params_.frames = completed(params_.frames, params_.robot);
    requireUsable(params_);
    registers_ = !params_.reference_robot.empty() && params_.reference_robot != params_.robot;
    if (params_.reference_map_frame.empty()) params_.reference_map_frame = params_.reference_robot + "/map";
    links_.emplace(params_.robot, params_.reference_robot, params_.other_robots, params_.tracker);
    diagnostics_.emplace(node, getPrivateNodeHandle(), "registration");
    registrar_.emplace(params_.landmarks, params_.registration);
    smoother_.emplace(params_.tf_smoothing_s);
    topics_.emplace(node, params_, registers_);
    if (registers_) startRegistering(node);
    followAll(node);
    serve(node);
    attempt_timer_ =
        node.createTimer(ros::Duration(params_.period_s), [this](const ros::TimerEvent&) { attempt(); });
    collect_timer_ =
        node.createTimer(ros::Duration(params_.tf_period_s), [this](const ros::TimerEvent&) { collect(); });
  }

  void startRegistering(ros::NodeHandle& node) {
    listener_.emplace(tf_buffer_, node);
    broadcaster_.emplace();
    tf_timer_ =
        node.createTimer(ros::Duration(params_.tf_period_s), [this](const ros::TimerEvent&) { broadcast(); });
  }

  void followAll(ros::NodeHandle& node) {
    robots_.emplace(node, FollowedRobots::Callbacks{
                              [this](const std::string& robot, bool first) { mapBegan(robot, first); },
                              [this](const std::string& robot, const MapRegistration& m) { hear(robot, m); },
                              [this](const std::string& cause) { diagnostics_->dropped(cause); }});
    robots_->follow(params_.robot, true);
    if (registers_) robots_->follow(params_.reference_robot, false);
    for (const std::string& other : params_.other_robots) robots_->follow(other, false);
    if (!registers_) return;
    // The reference robot has every second turn: its link is worth most.
    for (const std::string& other : params_.other_robots) {
      turns_.push_back(params_.reference_robot);
      turns_.push_back(other);
    }
    if (turns_.empty()) turns_.push_back(params_.reference_robot);
  }

  // Aligning files takes a while: it has a thread of its own, in which nothing of this object changes.
  void serve(const ros::NodeHandle& node) {
    ros::NodeHandle slow(node);
    slow.setCallbackQueue(&slow_queue_);
    align_service_ = slow.advertiseService<AlignMaps::Request, AlignMaps::Response>(
        "align", [this](AlignMaps::Request& request, AlignMaps::Response& response) {
          response = alignFiles(request, params_.landmarks, params_.registration);
          return true;
        });
    slow_spinner_.emplace(1, &slow_queue_);
    slow_spinner_->start();
  }

  void mapBegan(const std::string& robot, bool first) {
    if (robot != params_.robot)
      links_->beginAnew(robot, robots_->at(robot).tiles.epoch());
    else if (!first)
      links_->beginAnew(robot + ": the map began anew");
    if (!first) last_broadcast_ = ros::Time();  // maps begin anew when time has jumped back, too
    refresh();
  }

  // What another robot tells of its own place in the reference map.
  void hear(const std::string& robot, const MapRegistration& message) {
    try {
      const bool same_reference = message.reference_robot == params_.reference_robot;
      links_->hear(robot, same_reference ? fromMessage(message) : std::nullopt);
    } catch (const InputError& error) {
      links_->hear(robot, std::nullopt);
      diagnostics_->dropped(robot + ": " + error.what());
    }
    refresh();
  }

  // Looks at maps that changed, in a thread of its own: callbacks never wait for it.
  void attempt() {
    collect();
    if (!job_.valid()) {  // else it is still at the last maps
      const auto robot = robots_->nextTurn(params_.robot, turns_);
      const bool changed = robots_->changed() && !robots_->at(params_.robot).tiles.empty();
      if (robot || changed) startJob(robot.value_or(""));
    }
    refresh();
    if (registers_) topics_->publishRegistration(shared_, *robots_);
  }

  void startJob(const std::string& robot) {
    RegistrationJob job;
    job.robot = robot;
    job.own = robots_->at(params_.robot).tiles;
    job.task.time_s = ros::Time::now().toSec();
    job.task.current_anew = robots_->isAnew(params_.robot);
    if (!robot.empty()) {
      job.other = robots_->at(robot).tiles;
      job.task.reference_robot = robot;
      job.task.reference_anew = robots_->isAnew(robot);
      job.task.hints = hintsFor(robot);
    }
    if (topics_->mergedIsWanted()) wantMerged(job);
    job_ = std::async(std::launch::async,
                      [this, job = std::move(job)]() mutable { return run(std::move(job), *registrar_); });
  }

  // All maps whose place in the reference map is known; none unless this robot's own is.
  void wantMerged(RegistrationJob& job) const {
    if (registers_ && shared_.state != RegistrationState::kRegistered) return;
    job.merge_into = robots_->at(registers_ ? params_.reference_robot : params_.robot).tiles;
    if (registers_)
      job.merge.push_back({robots_->at(params_.robot).tiles, shared_.route->reference_from_current});
    for (const std::string& other : params_.other_robots) {
      const auto route = links_->routeOf(other);
      if (route) job.merge.push_back({robots_->at(other).tiles, route->reference_from_current});
    }
    if (job.merge_into->empty() || job.merge.empty()) job.merge_into.reset();
  }

  RegistrationHints hintsFor(const std::string& robot) const {
    RegistrationHints hints;
    hints.prior = links_->priorFor(robot, shared_);
    if (!hints.prior && params_.initial.known && robot == params_.reference_robot)
      hints.prior = params_.initial.reference_from_current;
    hints.focus_in_current_m = whereTheRobotIs();
    return hints;
  }

  // Takes up what a finished job found, unless one of its maps has begun anew meanwhile.
  void collect() {
    if (!job_.valid() || job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    const RegistrationFindings found = job_.get();
    const std::string& robot = found.job.robot;
    const auto isOld = [&](const std::string& name, const TileFollower& tiles) {
      return robots_->at(name).tiles.epoch() != tiles.epoch();
    };
    if (isOld(params_.robot, found.job.own) || (!robot.empty() && isOld(robot, found.job.other))) return;
    topics_->publishLandmarks(found);
    diagnostics_->processed(found.elapsed_s);
    centre_m_ = found.centre_m;
    if (!robot.empty()) takeUp(robot, found.attempt);
    if (found.merged) topics_->publishMerged(*found.merged);
  }

  void takeUp(const std::string& robot, const RegistrationAttempt& attempt) {
    if (robot == params_.reference_robot) refusal_ = attempt.outcome.refusal;
    // An answer that the tracker holds back as an outlier must not lend its pairs to the frame that stands.
    if (links_->update(robot, attempt.outcome.registration, centre_m_, ros::Time::now().toSec()))
      topics_->keepPairs(robot, attempt);
    refresh();
    topics_->publishRegistration(shared_, *robots_);
  }

  // The shared frame from all that is known now.
  void refresh() {
    if (!registers_) return;
    const RegistrationState before = shared_.state;
    shared_ = links_->shared(centre_m_, ros::Time::now().toSec());
    if (shared_.state == RegistrationState::kNone && !refusal_.empty()) shared_.reason = refusal_;
    if (shared_.state != RegistrationState::kRegistered) smoother_->reset();
    if (shared_.state != before) topics_->publishRegistration(shared_, *robots_);  // at once
  }

  // In its own map; empty while tf does not say.
  std::optional<Eigen::Vector2d> whereTheRobotIs() const {
    const auto map_from_base = lookUp(tf_buffer_, params_.frames.map, params_.frames.base, ros::Time(0));
    if (!map_from_base) return std::nullopt;
    return Eigen::Vector2d(map_from_base->translation().head<2>());
  }

  void broadcast() {
    const ros::Time now = ros::Time::now();
    if (shared_.state != RegistrationState::kRegistered || now <= last_broadcast_) return;
    last_broadcast_ = now;
    const Pose2 shown = smoother_->follow(shared_.route->reference_from_current, centre_m_, now.toSec());
    broadcaster_->sendTransform(toStamped(shown, params_.reference_map_frame, params_.frames.map, now));
  }

  RegistrationNodeletParams params_;
  bool registers_ = false;
  std::optional<RobotLinks> links_;
  SharedFrame shared_;
  std::optional<FollowedRobots> robots_;
  std::vector<std::string> turns_;         // robots to be compared with, one after the other
  std::optional<MapRegistrar> registrar_;  // used by the job alone while there is one
  std::optional<FrameSmoother> smoother_;
  Eigen::Vector2d centre_m_ = Eigen::Vector2d::Zero();  // of the own map, where answers are compared
  std::optional<StageDiagnostics> diagnostics_;
  std::string refusal_;  // of the newest attempt with the reference robot
  std::optional<RegistrationTopics> topics_;
  tf2_ros::Buffer tf_buffer_;
  std::optional<tf2_ros::TransformListener> listener_;
  std::optional<tf2_ros::TransformBroadcaster> broadcaster_;
  ros::Timer attempt_timer_;
  ros::Timer collect_timer_;
  ros::Timer tf_timer_;
  ros::Time last_broadcast_;
  ros::CallbackQueue slow_queue_;
  ros::ServiceServer align_service_;
  std::optional<ros::AsyncSpinner> slow_spinner_;
  std::future<RegistrationFindings> job_;  // last: it ends before what it uses
};

std::unique_ptr<nodelet::Nodelet> makeRegistration() { return std::make_unique<RegistrationNodelet>(); }

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::RegistrationNodelet, nodelet::Nodelet)
