// Ranges and odometry in, a map and the drift of the odometry out. Takes disparity (with disparity_sigma and
// reference/camera_info), depth (with camera_info) or scan, and tf; gives map, map_updates, map_metadata,
// map_tiles, the same of each level as map/<level>, stereo_scan, tf map -> odom; services save_map, load_map,
// static_map, reset.
#include <message_filters/subscriber.h>
#include <message_filters/time_synchronizer.h>
#include <nav_msgs/GetMap.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <pluginlib/class_list_macros.hpp>

#include <boost/bind/bind.hpp>
#include <optional>

#include "cornerstone/MapFile.h"
#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/map_files.h"
#include "cornerstone/ros/diagnostics.h"
#include "cornerstone/ros/grid_messages.h"
#include "cornerstone/ros/image_messages.h"
#include "cornerstone/ros/map_publisher.h"
#include "cornerstone/ros/nodelet_params.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/ros/pending_scans.h"
#include "cornerstone/ros/scan_messages.h"
#include "nodelets/factories.h"
#include "nodelets/nodelet_start.h"

namespace cornerstone {

class OccupancyMapperNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    startOrRefuse(getName(), [this] { start(); });
  }

  void start() {
    ros::NodeHandle& node = getNodeHandle();
    params_ = loadParams<OccupancyMapperParams>(getPrivateNodeHandle());
    params_.frames = completed(params_.frames, params_.robot);
    requirePositive(params_.publish_period_s, "parameter 'publish_period_s'");
    requirePositive(params_.tf_period_s, "parameter 'tf_period_s'");
    requirePositive(params_.tf_timeout_s, "parameter 'tf_timeout_s'");
    requireWithin(params_.disparity_sigma_px, 0, 10, "parameter 'disparity_sigma_px'");
    requireValid(params_.scan);
    mapper_.emplace(params_.mapper, params_.scan.levels.size());
    begin();
    diagnostics_.emplace(node, getPrivateNodeHandle(), "mapper");
    pending_.emplace(params_.tf_timeout_s,
                     [this](const std::string& cause) { diagnostics_->dropped(cause); });
    tf_listener_.emplace(tf_buffer_);
    map_publisher_.emplace(node, MapPublisherSetup{params_.robot, params_.frames.map, levelNames()});
    scan_publisher_ = node.advertise<sensor_msgs::LaserScan>("stereo_scan", 1);
    subscribe(node);
    serve(node);
    publish_timer_ = node.createTimer(ros::Duration(params_.publish_period_s),
                                      [this](const ros::TimerEvent&) { map_publisher_->publish(*mapper_); });
    tf_timer_ =
        node.createTimer(ros::Duration(params_.tf_period_s), [this](const ros::TimerEvent&) { tick(); });
  }

  void subscribe(ros::NodeHandle& node) {
    namespace p = boost::placeholders;
    if (params_.input == "disparity") {
      info_subscriber_ = node.subscribe("reference/camera_info", 1, &OccupancyMapperNodelet::takeInfo, this);
      if (params_.disparity_sigma_px > 0) {
        range_subscriber_ = node.subscribe<stereo_msgs::DisparityImage>(
            "disparity", 5,
            [this](const stereo_msgs::DisparityImageConstPtr& m) { takeDisparity(m, nullptr); });
        return;
      }
      disparities_.subscribe(node, "disparity", 5);
      sigmas_.subscribe(node, "disparity_sigma", 5);
      pairs_.emplace(disparities_, sigmas_, 5);
      pairs_->registerCallback(boost::bind(&OccupancyMapperNodelet::takeDisparity, this, p::_1, p::_2));
    } else if (params_.input == "depth") {
      info_subscriber_ = node.subscribe("camera_info", 1, &OccupancyMapperNodelet::takeInfo, this);
      range_subscriber_ = node.subscribe("depth", 5, &OccupancyMapperNodelet::takeDepth, this);
    } else if (params_.input == "scan") {
      range_subscriber_ = node.subscribe("scan", 5, &OccupancyMapperNodelet::takeLaser, this);
    } else {
      throw InputError("parameter 'input' is '" + params_.input + "', it must be disparity, depth or scan");
    }
  }

  void serve(ros::NodeHandle& node) {
    services_ = {node.advertiseService("save_map", &OccupancyMapperNodelet::saveMapFile, this),
                 node.advertiseService("load_map", &OccupancyMapperNodelet::loadMapFile, this),
                 node.advertiseService("static_map", &OccupancyMapperNodelet::giveMap, this),
                 node.advertiseService("reset", &OccupancyMapperNodelet::reset, this)};
  }

  void takeInfo(const sensor_msgs::CameraInfoConstPtr& info) { info_ = info; }

  using Convert = std::function<RangeScan(const Eigen::Isometry3d& level_from_sensor)>;

  void takeDisparity(const stereo_msgs::DisparityImageConstPtr& message,
                     const sensor_msgs::ImageConstPtr& sigma) {
    take(message->header, [this, message, sigma, info = info_](const Eigen::Isometry3d& level_from_sensor) {
      if (!info) throw InputError("reference/camera_info: none received yet");
      const cv::Mat1f sigma_px =
          sigma ? floatImage(*sigma, "disparity_sigma")
                : cv::Mat1f(static_cast<int>(message->image.height), static_cast<int>(message->image.width),
                            static_cast<float>(params_.disparity_sigma_px));
      return scanFromDisparity(fromDisparityImage(*message, *info, sigma_px), level_from_sensor,
                               params_.scan);
    });
  }

  void takeDepth(const sensor_msgs::ImageConstPtr& message) {
    take(message->header, [this, message, info = info_](const Eigen::Isometry3d& level_from_sensor) {
      if (!info) throw InputError("camera_info: none received yet");
      return scanFromDepth(fromDepthImage(message, *info), params_.depth, level_from_sensor, params_.scan);
    });
  }

  void takeLaser(const sensor_msgs::LaserScanConstPtr& message) {
    take(message->header, [this, message](const Eigen::Isometry3d& level_from_sensor) {
      return scanFromRanges(fromLaserScan(*message, planarPart(level_from_sensor)), params_.laser);
    });
  }

  // What all kinds of ranges share: order, and waiting for where they were taken.
  void take(const std_msgs::Header& header, Convert convert) {
    if (pending_->jumpedBack(header.stamp)) {
      tf_buffer_.clear();  // else poses of the old time would be mixed with those of the new one
      beginAnew("time jumped back");
    }
    pending_->add({header.stamp, header.frame_id, std::move(convert)});
    release();
  }

  void release() {
    pending_->release(tf_buffer_, {params_.frames.odom, params_.frames.base, params_.use_tilt},
                      [this](const PendingScan& pending, const LookPose& pose) { map(pending, pose); });
  }

  // A message at fault is counted and left out.
  void map(const PendingScan& pending, const LookPose& pose) {
    const ros::WallTime start = ros::WallTime::now();
    try {
      const RangeScan scan = pending.convert(pose.level_from_sensor);
      const int slips = mapper_->slips();
      mapper_->update(scan, pose.odom_from_base);
      if (mapper_->slips() > slips)
        NODELET_WARN_THROTTLE(10, "the robot was not where odometry had it (slips so far: %d)",
                              mapper_->slips());
      diagnostics_->complain("");
      diagnostics_->processed((ros::WallTime::now() - start).toSec());
      publishScan(scan, pending.stamp);
    } catch (const InputError& error) {
      diagnostics_->complain(error.what());
      diagnostics_->dropped(error.what());
    }
  }

  void publishScan(const RangeScan& scan, const ros::Time& stamp) {
    if (scan_publisher_.getNumSubscribers() == 0) return;
    std_msgs::Header header;
    header.stamp = stamp;
    header.frame_id = params_.frames.base;
    scan_publisher_.publish(toLaserScan(scan, header));
  }

  void tick() {
    release();
    const ros::Time now = ros::Time::now();
    if (now <= last_broadcast_) return;
    last_broadcast_ = now;
    broadcaster_.sendTransform(
        toStamped(mapper_->mapFromOdom(), params_.frames.map, params_.frames.odom, now));
  }

  std::vector<std::string> levelNames() const {
    std::vector<std::string> names;
    for (const Level& level : params_.scan.levels) names.push_back(level.name);
    return names;
  }

  // As the parameters say: in an empty map or in a saved one.
  void begin() {
    if (params_.load_map.empty()) return;
    try {
      mapper_->load(loadLevels(params_.load_map, levelNames()), params_.start);
    } catch (const InputError& error) {
      throw InputError(std::string("parameter 'load_map': ") + error.what());
    }
  }

  void beginAnew(const std::string& reason) {
    NODELET_WARN_STREAM(getName() << ": " << reason << ": the map begins anew");
    mapper_->reset();
    try {
      begin();
    } catch (const InputError& error) {  // the file was there at the start
      diagnostics_->dropped(error.what());
    }
    pending_->clear();
    last_broadcast_ = ros::Time();
    map_publisher_->publish(*mapper_);
  }

  bool saveMapFile(MapFile::Request& request, MapFile::Response& response) {
    return attempt(response, [&] {
      std::vector<GridMap> levels;
      for (std::size_t i = 0; i < params_.scan.levels.size(); ++i) levels.push_back(mapper_->map(i));
      saveLevels(levels, request.path, levelNames());
    });
  }

  bool loadMapFile(MapFile::Request& request, MapFile::Response& response) {
    return attempt(response, [&] {
      const Pose2 map_from_base{request.x, request.y, request.yaw};
      if (!map_from_base.isFinite()) throw InputError("load_map: x, y or yaw is not finite");
      mapper_->load(loadLevels(request.path, levelNames()), map_from_base);
      pending_->clear();
      map_publisher_->publish(*mapper_);
    });
  }

  static bool attempt(MapFile::Response& response, const std::function<void()>& work) {
    try {
      work();
      response.success = true;
    } catch (const InputError& error) {
      response.message = error.what();
    }
    return true;
  }

  bool giveMap(nav_msgs::GetMap::Request&, nav_msgs::GetMap::Response& response) {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = params_.frames.map;
    response.map = toOccupancyGrid(mapper_->map(), header);
    return true;
  }

  bool reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    beginAnew("reset was called");
    response.success = true;
    return true;
  }

  OccupancyMapperParams params_;
  std::optional<Mapper> mapper_;
  std::optional<StageDiagnostics> diagnostics_;
  std::optional<PendingScans> pending_;
  std::optional<MapPublisher> map_publisher_;
  tf2_ros::Buffer tf_buffer_;
  std::optional<tf2_ros::TransformListener> tf_listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  message_filters::Subscriber<stereo_msgs::DisparityImage> disparities_;
  message_filters::Subscriber<sensor_msgs::Image> sigmas_;
  std::optional<message_filters::TimeSynchronizer<stereo_msgs::DisparityImage, sensor_msgs::Image>> pairs_;
  ros::Subscriber range_subscriber_;
  ros::Subscriber info_subscriber_;
  sensor_msgs::CameraInfoConstPtr info_;
  ros::Publisher scan_publisher_;
  std::vector<ros::ServiceServer> services_;
  ros::Timer publish_timer_;
  ros::Timer tf_timer_;
  ros::Time last_broadcast_;
};

std::unique_ptr<nodelet::Nodelet> makeOccupancyMapper() { return std::make_unique<OccupancyMapperNodelet>(); }

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::OccupancyMapperNodelet, nodelet::Nodelet)
