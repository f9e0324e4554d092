// Images of two or three cameras in, disparity out. Takes {reference,right,top}/{image_rect or image_raw,
// camera_info}; gives disparity, disparity_sigma, rejections.
#include <image_transport/subscriber_filter.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <sensor_msgs/image_encodings.h>
#include <pluginlib/class_list_macros.hpp>

#include <array>
#include <boost/bind/bind.hpp>
#include <deque>
#include <optional>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/diagnostics.h"
#include "cornerstone/ros/image_messages.h"
#include "cornerstone/ros/nodelet_params.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/stereo/rectifier.h"
#include "nodelets/factories.h"
#include "nodelets/nodelet_start.h"

namespace cornerstone {
namespace {

using sensor_msgs::ImageConstPtr;
using TwoImages = message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image>;
using ThreeImages = message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image,
                                                                    sensor_msgs::Image>;

constexpr std::array<const char*, 3> kCameras{"reference", "right", "top"};

// A set waits this long for calibrations: connections come one by one, and drivers repeat camera_info with
// every image.
constexpr double kCalibrationWait_s = 2;
constexpr int kStartImages = 30;  // reference images without a set before one counts as missing: 3 s at 10 Hz

// One camera: its images, the newest calibration and, for raw images, the rectification made from it.
struct Camera {
  std::string name;
  image_transport::SubscriberFilter images;
  ros::Subscriber info_subscriber;
  sensor_msgs::CameraInfo info;
  std::optional<CameraCalibration> calibration;
  std::optional<Rectifier> rectifier;
  cv::Mat1b rectified;  // kept, so that nothing is allocated image by image
};

struct ImageSet {
  std::array<ImageConstPtr, 3> images;  // by kCameras; the last is null with two cameras
  ros::WallTime taken;
};

}  // namespace

class TrinocularStereoNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    startOrRefuse(getName(), [this] { start(); });
  }

  void start() {
    ros::NodeHandle& node = getNodeHandle();
    params_ = loadParams<TrinocularStereoParams>(getPrivateNodeHandle());
    if (params_.images != "image_rect" && params_.images != "image_raw")
      throw InputError("parameter 'images' is '" + params_.images + "', it must be image_rect or image_raw");
    requireWithin(params_.sync_tolerance_s, 0, 1, "parameter 'sync_tolerance_s'");
    requirePositive(params_.queue_size, "parameter 'queue_size'");
    matcher_.emplace(params_.stereo);
    diagnostics_.emplace(node, getPrivateNodeHandle(), "stereo");
    disparity_publisher_ = node.advertise<stereo_msgs::DisparityImage>("disparity", 1);
    sigma_publisher_ = node.advertise<sensor_msgs::Image>("disparity_sigma", 1);
    rejections_publisher_ = node.advertise<sensor_msgs::Image>("rejections", 1);
    subscribe(node);
    held_timer_ = node.createWallTimer(ros::WallDuration(kCalibrationWait_s / 4),
                                       [this](const ros::WallTimerEvent&) { dropOldHeld(); });
  }

  std::size_t cameraCount() const { return params_.third_camera ? 3 : 2; }

  void subscribe(ros::NodeHandle& node) {
    transport_.emplace(node);
    for (std::size_t i = 0; i < cameraCount(); ++i) {
      Camera& camera = cameras_[i];
      camera.name = node.resolveName(kCameras[i]);
      camera.info_subscriber = node.subscribe<sensor_msgs::CameraInfo>(
          std::string(kCameras[i]) + "/camera_info", 1,
          [this, &camera](const sensor_msgs::CameraInfoConstPtr& info) { takeCalibration(camera, *info); });
      camera.images.subscribe(*transport_, std::string(kCameras[i]) + "/" + params_.images,
                              static_cast<unsigned>(params_.queue_size));
    }
    namespace p = boost::placeholders;
    const auto queue = static_cast<unsigned>(params_.queue_size);
    cameras_[0].images.registerCallback(boost::bind(&TrinocularStereoNodelet::await, this, p::_1));
    if (params_.third_camera) {
      three_.emplace(ThreeImages(queue), cameras_[0].images, cameras_[1].images, cameras_[2].images);
      three_->setMaxIntervalDuration(ros::Duration(params_.sync_tolerance_s));
      three_->registerCallback(boost::bind(&TrinocularStereoNodelet::take, this, p::_1, p::_2, p::_3));
    } else {
      two_.emplace(TwoImages(queue), cameras_[0].images, cameras_[1].images);
      two_->setMaxIntervalDuration(ros::Duration(params_.sync_tolerance_s));
      two_->registerCallback(
          boost::bind(&TrinocularStereoNodelet::take, this, p::_1, p::_2, ImageConstPtr()));
    }
  }

  void takeCalibration(Camera& camera, const sensor_msgs::CameraInfo& info) {
    sensor_msgs::CameraInfo unstamped = info;
    unstamped.header = camera.info.header;
    if (camera.calibration && unstamped == camera.info) return;
    camera.info = unstamped;
    camera.calibration = toCalibration(info, camera.name + "/camera_info");
    camera.rectifier.reset();
    rig_.reset();
    if (uncalibrated().empty()) matchHeld();
  }

  // What is said of the first camera without a calibration; empty: all have one.
  std::string uncalibrated() const {
    for (std::size_t i = 0; i < cameraCount(); ++i)
      if (!cameras_[i].calibration) return cameras_[i].name + "/camera_info: none received yet";
    return {};
  }

  void matchHeld() {
    std::deque<ImageSet> sets;
    sets.swap(held_);
    for (const ImageSet& set : sets) match(set);
  }

  void dropOldestHeld() {
    held_.pop_front();
    diagnostics_->complain(uncalibrated());
    diagnostics_->dropped(uncalibrated());
  }

  // The calibrations may never come.
  void dropOldHeld() {
    const ros::WallTime now = ros::WallTime::now();
    while (!held_.empty() && (now - held_.front().taken).toSec() > kCalibrationWait_s) dropOldestHeld();
  }

  // The newest sets wait for the cameras' first calibrations.
  void hold(const ImageSet& set) {
    held_.push_back(set);
    if (held_.size() > static_cast<std::size_t>(params_.queue_size)) dropOldestHeld();
  }

  // Remembers each reference image until its set is complete, so that incomplete sets are counted.
  void await(const ImageConstPtr& reference) {
    // At the start the cameras' connections come one by one.
    if (!any_set_ && ++before_first_set_ < kStartImages) return;
    awaited_.push_back(reference->header.stamp);
    if (awaited_.size() > static_cast<std::size_t>(params_.queue_size)) dropAwaited();
  }

  void dropAwaited() {
    awaited_.pop_front();
    diagnostics_->dropped("a set of images is incomplete: a camera is silent or its stamps differ");
  }

  // The rig of the calibrations seen last; InputError when they do not fit together.
  const TrinocularRig& rig() {
    if (rig_) return *rig_;
    if (params_.images == "image_raw")
      for (std::size_t i = 0; i < cameraCount(); ++i) cameras_[i].rectifier.emplace(*cameras_[i].calibration);
    rig_ = makeRig(*cameras_[0].calibration, *cameras_[1].calibration, cameras_[2].calibration);
    return *rig_;
  }

  cv::Mat1b imageOf(Camera& camera, const ImageConstPtr& message) {
    if (!message) return {};
    const cv::Mat1b grey = toGrey(message, camera.name + "/" + params_.images);
    if (!camera.rectifier) return grey;
    camera.rectifier->rectify(grey, camera.rectified);
    return camera.rectified;
  }

  void take(const ImageConstPtr& reference, const ImageConstPtr& right, const ImageConstPtr& top) {
    any_set_ = true;
    while (!awaited_.empty() && awaited_.front() < reference->header.stamp) dropAwaited();
    if (!awaited_.empty() && awaited_.front() == reference->header.stamp) awaited_.pop_front();
    const ImageSet set{{reference, right, top}, ros::WallTime::now()};
    uncalibrated().empty() ? match(set) : hold(set);
  }

  void match(const ImageSet& set) {
    try {
      const ros::WallTime start = ros::WallTime::now();
      const TrinocularRig& known_rig = rig();
      const StereoImages images{imageOf(cameras_[0], set.images[0]), imageOf(cameras_[1], set.images[1]),
                                imageOf(cameras_[2], set.images[2])};
      publish(matcher_->match(images, known_rig), set.images[0]->header);
      diagnostics_->complain("");
      diagnostics_->processed((ros::WallTime::now() - start).toSec());
    } catch (const InputError& error) {
      diagnostics_->complain(error.what());
      diagnostics_->dropped(error.what());
    }
  }

  void publish(const Disparity& disparity, const std_msgs::Header& header) {
    namespace encodings = sensor_msgs::image_encodings;
    const double searched_px = params_.stereo.max_disparity_px;
    disparity_publisher_.publish(toDisparityImage(disparity, {0, searched_px}, header));
    sigma_publisher_.publish(toImage(disparity.sigma_px, encodings::TYPE_32FC1, header));
    if (rejections_publisher_.getNumSubscribers() > 0)
      rejections_publisher_.publish(toImage(disparity.rejection, encodings::MONO8, header));
  }

  TrinocularStereoParams params_;
  std::optional<StereoMatcher> matcher_;
  std::optional<StageDiagnostics> diagnostics_;
  std::optional<image_transport::ImageTransport> transport_;
  std::array<Camera, 3> cameras_;
  std::optional<TrinocularRig> rig_;
  bool any_set_ = false;
  int before_first_set_ = 0;   // reference images
  std::deque<ImageSet> held_;  // complete sets that came before the calibrations, oldest first
  ros::WallTimer held_timer_;
  std::deque<ros::Time> awaited_;  // stamps of reference images whose set is not complete yet
  std::optional<message_filters::Synchronizer<TwoImages>> two_;
  std::optional<message_filters::Synchronizer<ThreeImages>> three_;
  ros::Publisher disparity_publisher_;
  ros::Publisher sigma_publisher_;
  ros::Publisher rejections_publisher_;
};

std::unique_ptr<nodelet::Nodelet> makeTrinocularStereo() {
  return std::make_unique<TrinocularStereoNodelet>();
}

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::TrinocularStereoNodelet, nodelet::Nodelet)
