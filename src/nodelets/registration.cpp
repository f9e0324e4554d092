// This robot's landmarks, and the pose of its map in the reference robot's map. Takes map_tiles of both
// robots; gives landmarks, landmark_markers, registration, match_markers, merged_map and, while registered,
// the tf between the maps.
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <future>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "cornerstone/base/errors.h"
#include "cornerstone/registration/frame_smoother.h"
#include "cornerstone/registration/map_registrar.h"
#include "cornerstone/registration/merge_maps.h"
#include "cornerstone/ros/diagnostics.h"
#include "cornerstone/ros/grid_messages.h"
#include "cornerstone/ros/landmark_messages.h"
#include "cornerstone/ros/nodelet_params.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/ros/tile_follower.h"
#include "cornerstone/ros/transforms.h"
#include "nodelets/factories.h"
#include "nodelets/nodelet_start.h"

namespace cornerstone {
namespace {

using MapVersion = std::pair<std::uint32_t, std::uint32_t>;  // epoch, version

// One robot's map as its tiles arrive.
struct RobotMap {
  TileFollower tiles;
  ros::Subscriber subscriber;
  std::optional<MapVersion> tried;  // the version of the last attempt

  MapVersion version() const { return {tiles.epoch(), tiles.version()}; }
  bool isNew() const { return !tiles.empty() && tried != version(); }
  bool beganAnew() const { return tried && tried->first != tiles.epoch(); }
};

// What an attempt in the background brings home.
struct Job {
  RegistrationAttempt attempt;
  std::optional<GridMap> merged;
  MapVersion own, reference;  // the maps it looked at
  Eigen::Vector2d centre_m;   // of the own map, where answers are compared
  double elapsed_s = 0;
};

}  // namespace

class RegistrationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    startOrRefuse(getName(), [this] { start(); });
  }

  void start() {
    ros::NodeHandle& node = getNodeHandle();
    params_ = loadParams<RegistrationNodeletParams>(getPrivateNodeHandle());
    params_.frames = completed(params_.frames, params_.robot);
    requirePositive(params_.period_s, "parameter 'period_s'");
    requirePositive(params_.tf_period_s, "parameter 'tf_period_s'");
    registers_ = !params_.reference_robot.empty() && params_.reference_robot != params_.robot;
    if (params_.reference_map_frame.empty()) params_.reference_map_frame = params_.reference_robot + "/map";
    tracker_.emplace(params_.tracker);
    diagnostics_.emplace(node, getPrivateNodeHandle(), "registration");
    landmarks_publisher_ = node.advertise<CornerArray>("landmarks", 1, true);
    markers_publisher_ = node.advertise<visualization_msgs::MarkerArray>("landmark_markers", 1, true);
    follow(own_, node.resolveName("map_tiles"));
    if (registers_) startRegistering(node);
    registrar_.emplace(params_.landmarks, params_.registration);
    smoother_.emplace(params_.tf_smoothing_s);
    attempt_timer_ =
        node.createTimer(ros::Duration(params_.period_s), [this](const ros::TimerEvent&) { attempt(); });
    collect_timer_ =
        node.createTimer(ros::Duration(params_.tf_period_s), [this](const ros::TimerEvent&) { collect(); });
  }

  void startRegistering(ros::NodeHandle& node) {
    registration_publisher_ = node.advertise<MapRegistration>("registration", 1, true);
    matches_publisher_ = node.advertise<visualization_msgs::MarkerArray>("match_markers", 1, true);
    merged_publisher_ = node.advertise<nav_msgs::OccupancyGrid>("merged_map", 1, true);
    // The other robots stand beside this one's namespace: /b follows /a/map_tiles.
    const std::string beside = ros::names::parentNamespace(node.getNamespace());
    follow(reference_, ros::names::append(beside, params_.reference_robot + "/map_tiles"));
    listener_.emplace(tf_buffer_, node);
    broadcaster_.emplace();
    tf_timer_ =
        node.createTimer(ros::Duration(params_.tf_period_s), [this](const ros::TimerEvent&) { broadcast(); });
  }

  void follow(RobotMap& robot, const std::string& topic) {
    robot.subscriber =
        getNodeHandle().subscribe<MapTiles>(topic, 100, [this, &robot, topic](const MapTilesConstPtr& tiles) {
          try {
            if (!robot.tiles.take(*tiles)) return;
            tracker_->lose(topic + ": the map began anew");
            smoother_->reset();
            last_broadcast_ = ros::Time();  // maps begin anew when time has jumped back, too
          } catch (const InputError& error) {
            diagnostics_->dropped(topic + ": " + error.what());
          }
        });
  }

  // Looks at maps that changed, in a thread of its own: callbacks never wait for it.
  void attempt() {
    collect();
    if (job_.valid()) return;  // still at the last maps
    const bool both = registers_ && !own_.tiles.empty() && !reference_.tiles.empty();
    if (own_.isNew() || (both && reference_.isNew())) startJob(both);
    if (registers_) publishRegistration();
  }

  void startJob(bool both) {
    RegistrationTask task;
    task.current = own_.tiles.map();
    if (both) task.reference = reference_.tiles.map();
    task.hints = hints();
    task.time_s = ros::Time::now().toSec();
    task.current_anew = own_.beganAnew();
    task.reference_anew = reference_.beganAnew();
    own_.tried = own_.version();
    reference_.tried = reference_.version();
    std::optional<Pose2> merge_at;
    if (both && tracker_->state() == RegistrationState::kRegistered &&
        merged_publisher_.getNumSubscribers() > 0)
      merge_at = tracker_->estimate()->reference_from_current;
    Job job;
    job.own = own_.version();
    job.reference = reference_.version();
    job.centre_m = task.hints.focus_in_current_m.value_or(knownCentre(task.current));
    job_ = std::async(std::launch::async, [this, task = std::move(task), job, merge_at]() mutable {
      const ros::WallTime start = ros::WallTime::now();
      job.attempt = registrar_->attempt(task);
      if (merge_at) job.merged = mergeMaps(*task.reference, task.current, *merge_at);
      job.elapsed_s = (ros::WallTime::now() - start).toSec();
      return job;
    });
  }

  RegistrationHints hints() const {
    RegistrationHints hints;
    if (tracker_->state() == RegistrationState::kRegistered)
      hints.prior = tracker_->estimate()->reference_from_current;
    else if (params_.initial.known)
      hints.prior = params_.initial.reference_from_current;
    hints.focus_in_current_m = whereTheRobotIs();
    return hints;
  }

  // Takes up what a finished attempt found, unless one of its maps has begun anew meanwhile.
  void collect() {
    if (!job_.valid() || job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    const Job job = job_.get();
    if (job.own.first != own_.tiles.epoch() ||
        (registers_ && job.reference.first != reference_.tiles.epoch()))
      return;
    publishLandmarks(job);
    diagnostics_->processed(job.elapsed_s);
    if (!registers_ || reference_.tiles.empty()) return;
    refusal_ = job.attempt.outcome.refusal;
    const double now_s = ros::Time::now().toSec();
    // An answer that the tracker holds back as an outlier must not lend its pairs to the frame that stands.
    if (tracker_->update(job.attempt.outcome.registration, job.centre_m, now_s)) keepPairs(job.attempt);
    centre_m_ = job.centre_m;
    publishRegistration();
    if (job.merged) publishMerged(*job.merged);
  }

  // In its own map; empty while tf does not say.
  std::optional<Eigen::Vector2d> whereTheRobotIs() const {
    const auto map_from_base = lookUp(tf_buffer_, params_.frames.map, params_.frames.base, ros::Time(0));
    if (!map_from_base) return std::nullopt;
    return Eigen::Vector2d(map_from_base->translation().head<2>());
  }

  void publishLandmarks(const Job& job) {
    CornerArray message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = params_.frames.map;
    message.robot = params_.robot;
    std::tie(message.map_epoch, message.version) = job.own;
    const Landmarks& landmarks = job.attempt.landmarks;
    for (const CornerLandmark& corner : landmarks.corners)
      message.corners.push_back(toMessage(corner, message.header.stamp.toSec()));
    landmarks_publisher_.publish(message);
    if (markers_publisher_.getNumSubscribers() > 0)
      markers_publisher_.publish(toMarkers(landmarks, params_.landmarks.arm_length_m, message.header));
  }

  void publishRegistration() {
    const ros::Time now = ros::Time::now();
    MapRegistration message = toMessage(*tracker_, now.toSec());
    message.header.stamp = now;
    message.header.frame_id = message.reference_frame = params_.reference_map_frame;
    message.current_frame = params_.frames.map;
    message.reference_robot = params_.reference_robot;
    message.current_robot = params_.robot;
    message.reference_epoch = reference_.tiles.epoch();
    message.current_epoch = own_.tiles.epoch();
    if (message.state == MapRegistration::NONE && !refusal_.empty()) message.reason = refusal_;
    if (tracker_->estimate()) {
      message.reference_corners = reference_corners_;
      message.current_corners = current_corners_;
    }
    registration_publisher_.publish(message);
    if (message.state != MapRegistration::REGISTERED) return;
    if (matches_publisher_.getNumSubscribers() > 0) matches_publisher_.publish(toMatchMarkers(message));
  }

  void publishMerged(const GridMap& merged) {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = params_.reference_map_frame;
    merged_publisher_.publish(toOccupancyGrid(merged, header));
  }

  void keepPairs(const RegistrationAttempt& attempt) {
    const double now_s = ros::Time::now().toSec();
    reference_corners_.clear();
    current_corners_.clear();
    for (const auto& [reference, current] : attempt.pairs) {
      reference_corners_.push_back(toMessage(reference, now_s));
      current_corners_.push_back(toMessage(current, now_s));
    }
  }

  void broadcast() {
    const ros::Time now = ros::Time::now();
    if (tracker_->state() != RegistrationState::kRegistered) smoother_->reset();
    if (tracker_->state() != RegistrationState::kRegistered || now <= last_broadcast_) return;
    last_broadcast_ = now;
    const Pose2 shown =
        smoother_->follow(tracker_->estimate()->reference_from_current, centre_m_, now.toSec());
    broadcaster_->sendTransform(toStamped(shown, params_.reference_map_frame, params_.frames.map, now));
  }

  RegistrationNodeletParams params_;
  bool registers_ = false;
  RobotMap own_;
  RobotMap reference_;
  std::optional<RegistrationTracker> tracker_;
  std::optional<MapRegistrar> registrar_;  // used by the job alone while there is one
  std::optional<FrameSmoother> smoother_;
  Eigen::Vector2d centre_m_ = Eigen::Vector2d::Zero();  // of the own map, where answers are compared
  std::optional<StageDiagnostics> diagnostics_;
  std::string refusal_;
  std::vector<Corner> reference_corners_;  // the pairs of the newest answer that the tracker took
  std::vector<Corner> current_corners_;
  ros::Publisher landmarks_publisher_;
  ros::Publisher markers_publisher_;
  ros::Publisher registration_publisher_;
  ros::Publisher matches_publisher_;
  ros::Publisher merged_publisher_;
  tf2_ros::Buffer tf_buffer_;
  std::optional<tf2_ros::TransformListener> listener_;
  std::optional<tf2_ros::TransformBroadcaster> broadcaster_;
  ros::Timer attempt_timer_;
  ros::Timer collect_timer_;
  ros::Timer tf_timer_;
  ros::Time last_broadcast_;
  std::future<Job> job_;  // last: it ends before what it uses
};

std::unique_ptr<nodelet::Nodelet> makeRegistration() { return std::make_unique<RegistrationNodelet>(); }

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::RegistrationNodelet, nodelet::Nodelet)
