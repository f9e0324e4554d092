// Images of two or three cameras in, disparity out. Takes {reference,right,top}/{image_rect or image_raw,
// camera_info}; gives disparity, disparity_sigma, rejections, disparity_picture, each only for who listens.
#include <sensor_msgs/image_encodings.h>
#include <pluginlib/class_list_macros.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/image_messages.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/stereo/disparity_picture.h"
#include "cornerstone/stereo/rectifier.h"
#include "cornerstone/stereo/stereo_matcher.h"
#include "nodelets/factories.h"
#include "nodelets/image_sets.h"
#include "nodelets/nodelet_start.h"

namespace cornerstone {
namespace {

using sensor_msgs::ImageConstPtr;

// A set waits this long for calibrations: connections come one by one, and drivers repeat camera_info with
// every image.
constexpr double kCalibrationWait_s = 2;

// One camera: the newest calibration and, for raw images, the rectification made from it.
struct Camera {
  std::string name;
  ros::Subscriber info_subscriber;
  sensor_msgs::CameraInfo info;
  std::optional<CameraCalibration> calibration;
  std::optional<Rectifier> rectifier;
  cv::Mat1b rectified;  // kept, so that nothing is allocated image by image
};

// Fewer pixels with texture that have an answer, in so many sets on end: the images do not fit the
// calibrations.
constexpr double kLeastMatched = 0.1;
constexpr int kPoorSets = 10;

std::size_t cameraCount(const ImageSet& set) { return set.images[2] ? 3 : 2; }

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
    requireWithin(params_.third_camera_silence_s, 0, 3600, "parameter 'third_camera_silence_s'");
    requirePositive(params_.queue_size, "parameter 'queue_size'");
    matcher_.emplace(params_.stereo);
    diagnostics_.emplace(node, getPrivateNodeHandle(), "stereo");
    disparity_publisher_ = node.advertise<stereo_msgs::DisparityImage>("disparity", 1);
    sigma_publisher_ = node.advertise<sensor_msgs::Image>("disparity_sigma", 1);
    rejections_publisher_ = node.advertise<sensor_msgs::Image>("rejections", 1);
    picture_publisher_ = node.advertise<sensor_msgs::Image>("disparity_picture", 1);
    subscribe(node);
    held_timer_ = node.createWallTimer(ros::WallDuration(kCalibrationWait_s / 4),
                                       [this](const ros::WallTimerEvent&) { dropOldHeld(); });
  }

  void subscribe(ros::NodeHandle& node) {
    for (std::size_t i = 0; i < (params_.third_camera ? 3 : 2); ++i) {
      Camera& camera = cameras_[i];
      camera.name = node.resolveName(kCameras[i]);
      camera.info_subscriber = node.subscribe<sensor_msgs::CameraInfo>(
          std::string(kCameras[i]) + "/camera_info", 1,
          [this, &camera](const sensor_msgs::CameraInfoConstPtr& info) { takeCalibration(camera, *info); });
    }
    sets_.emplace(node, params_, *diagnostics_,
                  [this](const ImageSet& set) { uncalibrated(set).empty() ? match(set) : hold(set); });
  }

  void takeCalibration(Camera& camera, const sensor_msgs::CameraInfo& info) {
    sensor_msgs::CameraInfo unstamped = info;
    unstamped.header = camera.info.header;
    if (camera.calibration && unstamped == camera.info) return;
    camera.info = unstamped;
    camera.calibration = toCalibration(info, camera.name + "/camera_info");
    camera.rectifier.reset();
    for (auto& rig : rigs_) rig.reset();
    matchHeld();
  }

  // What is said of the set's first camera without a calibration; empty: all have one.
  std::string uncalibrated(const ImageSet& set) const {
    for (std::size_t i = 0; i < cameraCount(set); ++i)
      if (!cameras_[i].calibration) return cameras_[i].name + "/camera_info: none received yet";
    return {};
  }

  void matchHeld() {
    while (!held_.empty() && uncalibrated(held_.front()).empty()) {
      const ImageSet set = held_.front();
      held_.pop_front();
      match(set);
    }
  }

  void dropOldestHeld() {
    const std::string cause = uncalibrated(held_.front());
    held_.pop_front();
    diagnostics_->complain(cause);
    diagnostics_->dropped(cause);
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

  // The rig of the first `count` cameras' newest calibrations; InputError when they do not fit together.
  const TrinocularRig& rigOf(std::size_t count) {
    std::optional<TrinocularRig>& rig = rigs_[count - 2];
    if (rig) return *rig;
    if (params_.images == "image_raw")
      for (std::size_t i = 0; i < count; ++i)
        if (!cameras_[i].rectifier) cameras_[i].rectifier.emplace(*cameras_[i].calibration);
    rig = makeRig(*cameras_[0].calibration, *cameras_[1].calibration,
                  count > 2 ? cameras_[2].calibration : std::nullopt);
    return *rig;
  }

  cv::Mat1b imageOf(Camera& camera, const ImageConstPtr& message) {
    if (!message) return {};
    const cv::Mat1b grey = toGrey(message, camera.name + "/" + params_.images);
    if (!camera.rectifier) return grey;
    camera.rectifier->rectify(grey, camera.rectified);
    return camera.rectified;
  }

  void match(const ImageSet& set) {
    try {
      const ros::WallTime start = ros::WallTime::now();
      const TrinocularRig& rig = rigOf(cameraCount(set));
      const StereoImages images{imageOf(cameras_[0], set.images[0]), imageOf(cameras_[1], set.images[1]),
                                imageOf(cameras_[2], set.images[2])};
      requireUsable(images, rig);
      if (isWanted()) {
        matcher_->match(images, rig, disparity_);
        publish(set.images[0]->header);
      }
      const bool third_is_missing = params_.third_camera && !set.images[2];
      diagnostics_->complain(third_is_missing ? cameras_[2].name + " is silent: two cameras go on alone"
                                              : "");
      diagnostics_->processed((ros::WallTime::now() - start).toSec());
    } catch (const InputError& error) {
      diagnostics_->complain(error.what());
      diagnostics_->dropped(error.what());
    }
  }

  std::string complaintOf(const ImageSet& set) const {
    if (poor_sets_ >= kPoorSets)
      return "hardly a pixel matches: cameras swapped, calibrations of another rig, or images of different "
             "instants";
    if (params_.third_camera && !set.images[2])
      return cameras_[2].name + " is silent: two cameras go on alone";
    return {};
  }

  bool isWanted() const {
    return disparity_publisher_.getNumSubscribers() + sigma_publisher_.getNumSubscribers() +
               rejections_publisher_.getNumSubscribers() + picture_publisher_.getNumSubscribers() >
           0;
  }

  void publish(const std_msgs::Header& header) {
    namespace encodings = sensor_msgs::image_encodings;
    const double searched_px = params_.stereo.max_disparity_px;
    if (disparity_publisher_.getNumSubscribers() > 0)
      disparity_publisher_.publish(toDisparityImage(disparity_, {0, searched_px}, header));
    if (sigma_publisher_.getNumSubscribers() > 0)
      sigma_publisher_.publish(toImage(disparity_.sigma_px, encodings::TYPE_32FC1, header));
    if (rejections_publisher_.getNumSubscribers() > 0)
      rejections_publisher_.publish(toImage(disparity_.rejection, encodings::MONO8, header));
    if (picture_publisher_.getNumSubscribers() == 0) return;
    drawDisparity(disparity_.disparity_px, searched_px, picture_);
    picture_publisher_.publish(toImage(picture_, encodings::BGR8, header));
  }

  TrinocularStereoParams params_;
  std::optional<StereoMatcher> matcher_;
  std::optional<StageDiagnostics> diagnostics_;
  std::array<Camera, 3> cameras_;
  std::array<std::optional<TrinocularRig>, 2> rigs_;  // of two and of three cameras
  std::optional<ImageSets> sets_;
  std::deque<ImageSet> held_;  // complete sets that came before the calibrations, oldest first
  ros::WallTimer held_timer_;
  Disparity disparity_;
  int poor_sets_ = 0;  // on end, see kPoorSets
  cv::Mat3b picture_;
  ros::Publisher disparity_publisher_;
  ros::Publisher sigma_publisher_;
  ros::Publisher rejections_publisher_;
  ros::Publisher picture_publisher_;
};

std::unique_ptr<nodelet::Nodelet> makeTrinocularStereo() {
  return std::make_unique<TrinocularStereoNodelet>();
}

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::TrinocularStereoNodelet, nodelet::Nodelet)
