// This robot's landmarks, and the pose of its map in the reference robot's map. Takes map_tiles of both
// robots; gives landmarks, landmark_markers, registration, match_markers, merged_map and, while registered,
// the tf between the maps.
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <pluginlib/class_list_macros.hpp>

#include <optional>
#include <utility>
#include <vector>

#include "cornerstone/base/errors.h"
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

// What is known of one robot: its map as tiles, and the landmarks found in the version seen last.
struct RobotMap {
  TileFollower tiles;
  ros::Subscriber subscriber;
  GridMap map;
  Landmarks landmarks;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> seen;  // epoch, version

  // True: there is a newer map than at the last call, and landmarks are those of it.
  bool refresh(const LandmarkParams& params) {
    const std::pair newest(tiles.epoch(), tiles.version());
    if (tiles.empty() || seen == newest) return false;
    map = tiles.map();
    landmarks = detectLandmarks(map, params);
    seen = newest;
    return true;
  }
  MapView view() const { return {map, landmarks}; }
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
    attempt_timer_ =
        node.createTimer(ros::Duration(params_.period_s), [this](const ros::TimerEvent&) { attempt(); });
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
            last_broadcast_ = ros::Time();  // maps begin anew when time has jumped back, too
          } catch (const InputError& error) {
            diagnostics_->dropped(topic + ": " + error.what());
          }
        });
  }

  void attempt() {
    const ros::WallTime start = ros::WallTime::now();
    const bool own_changed = own_.refresh(params_.landmarks);
    if (own_changed) publishLandmarks();
    if (registers_) {
      const bool reference_changed = reference_.refresh(params_.landmarks);
      if ((own_changed || reference_changed) && own_.seen && reference_.seen) registerOnce();
      publishRegistration();
    }
    if (own_changed) diagnostics_->processed((ros::WallTime::now() - start).toSec());
  }

  void registerOnce() {
    RegistrationHints hints;
    if (tracker_->state() == RegistrationState::kRegistered)
      hints.prior = tracker_->estimate()->reference_from_current;
    hints.focus_in_current_m = whereTheRobotIs();
    auto [answer, refusal] = registerMaps(reference_.view(), own_.view(), hints, params_.registration);
    refusal_ = refusal;
    // Where the known frame no longer holds, the maps may say where the truth lies: that is a contradiction.
    if (!answer && hints.prior) {
      hints.prior.reset();
      answer = registerMaps(reference_.view(), own_.view(), hints, params_.registration).registration;
    }
    // Answers are compared, and followed, where the frame must be right.
    const double now_s = ros::Time::now().toSec();
    tracker_->update(answer, hints.focus_in_current_m.value_or(knownCentre(own_.map)), now_s);
    // An answer that the tracker holds back as an outlier must not lend its pairs to the frame that stands.
    if (answer && tracker_->evidenceTime() == now_s) keepMatches(*answer);
  }

  // In its own map; empty while tf does not say.
  std::optional<Eigen::Vector2d> whereTheRobotIs() const {
    const auto map_from_base = lookUp(tf_buffer_, params_.frames.map, params_.frames.base, ros::Time(0));
    if (!map_from_base) return std::nullopt;
    return Eigen::Vector2d(map_from_base->translation().head<2>());
  }

  void publishLandmarks() {
    CornerArray message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = params_.frames.map;
    message.robot = params_.robot;
    message.map_epoch = own_.tiles.epoch();
    message.version = own_.tiles.version();
    for (const CornerLandmark& corner : own_.landmarks.corners) message.corners.push_back(toMessage(corner));
    landmarks_publisher_.publish(message);
    if (markers_publisher_.getNumSubscribers() > 0)
      markers_publisher_.publish(toMarkers(own_.landmarks, params_.landmarks.arm_length_m, message.header));
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
    if (merged_publisher_.getNumSubscribers() > 0)
      merged_publisher_.publish(toOccupancyGrid(
          mergeMaps(reference_.map, own_.map, tracker_->estimate()->reference_from_current), message.header));
  }

  // The matches of an answer are indices into landmarks that the next map replaces.
  void keepMatches(const Registration& answer) {
    reference_corners_.clear();
    current_corners_.clear();
    for (const auto& [reference, current] : answer.matches) {
      reference_corners_.push_back(
          toMessage(reference_.landmarks.corners.at(static_cast<std::size_t>(reference))));
      current_corners_.push_back(toMessage(own_.landmarks.corners.at(static_cast<std::size_t>(current))));
    }
  }

  void broadcast() {
    const ros::Time now = ros::Time::now();
    if (tracker_->state() != RegistrationState::kRegistered || now <= last_broadcast_) return;
    last_broadcast_ = now;
    broadcaster_->sendTransform(toStamped(tracker_->estimate()->reference_from_current,
                                          params_.reference_map_frame, params_.frames.map, now));
  }

  RegistrationNodeletParams params_;
  bool registers_ = false;
  RobotMap own_;
  RobotMap reference_;
  std::optional<RegistrationTracker> tracker_;
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
  ros::Timer tf_timer_;
  ros::Time last_broadcast_;
};

std::unique_ptr<nodelet::Nodelet> makeRegistration() { return std::make_unique<RegistrationNodelet>(); }

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::RegistrationNodelet, nodelet::Nodelet)
