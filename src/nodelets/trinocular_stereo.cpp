// Images of two or three cameras in, disparity out. Takes {reference,right,top}/{image_rect or image_raw,
// camera_info}; gives disparity, disparity_sigma, rejections, disparity_picture, points, each only for who
// listens.
#include <dynamic_reconfigure/server.h>
#include <sensor_msgs/image_encodings.h>
#include <algorithm>
#include <iomanip>
#include <pluginlib/class_list_macros.hpp>
#include <sstream>
#include <utility>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/image_messages.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/ros/point_messages.h"
#include "cornerstone/ros/stereo_reconfigure.h"
#include "cornerstone/stereo/disparity_picture.h"
#include "cornerstone/stereo/rig_check.h"
#include "cornerstone/stereo/self_calibration.h"
#include "nodelets/factories.h"
#include "nodelets/image_sets.h"
#include "nodelets/nodelet_start.h"
#include "nodelets/stereo_cameras.h"

namespace cornerstone {
namespace {

// A set waits this long for calibrations: connections come one by one, and drivers repeat camera_info with
// every image.
constexpr double kCalibrationWait_s = 2;
constexpr std::size_t kMostHeld = 64;  // sets of so long at 30 Hz; 15 MB of 320x240 from three cameras

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
    // It starts from the values on the parameter server, which are those of params_.
    reconfigure_.emplace(ros::NodeHandle(getPrivateNodeHandle(), "stereo"));
    reconfigure_->setCallback([this](StereoConfig& config, unsigned) { reconfigure(config); });
    diagnostics_.emplace(node, getPrivateNodeHandle(), "stereo");
    advertise(node);
    cameras_.emplace(node, params_, [this] { takeCalibrations(); });
    if (params_.self_calibration)
      for (const int camera : params_.third_camera ? std::vector<int>{1, 2} : std::vector<int>{1})
        diagnostics_->tell(cameras_->nameOf(static_cast<std::size_t>(camera)) + " turned by px about x, y, z",
                           [this, camera] { return turnsOf(camera); });
    sets_.emplace(node, params_, *diagnostics_, [this](const ImageSet& set) {
      cameras_->uncalibrated(set).empty() ? match(set) : hold(set);
    });
    held_timer_ = node.createWallTimer(ros::WallDuration(kCalibrationWait_s / 4),
                                       [this](const ros::WallTimerEvent&) { dropOldHeld(); });
  }

  void advertise(ros::NodeHandle& node) {
    disparity_publisher_ = node.advertise<stereo_msgs::DisparityImage>("disparity", 1);
    sigma_publisher_ = node.advertise<sensor_msgs::Image>("disparity_sigma", 1);
    rejections_publisher_ = node.advertise<sensor_msgs::Image>("rejections", 1);
    picture_publisher_ = node.advertise<sensor_msgs::Image>("disparity_picture", 1);
    points_publisher_ = node.advertise<sensor_msgs::PointCloud2>("points", 1);
  }

  // What the matcher refuses changes nothing, and the caller is answered with what holds.
  void reconfigure(StereoConfig& config) {
    try {
      const StereoParams changed = changedBy(config, params_.stereo);
      StereoMatcher matcher(changed);  // before the present one is given up
      matcher_ = std::move(matcher);
      rig_check_.emplace(changed);
      params_.stereo = changed;
      config_ = config;
    } catch (const InputError& error) {
      NODELET_WARN_STREAM("refused: " << error.what());
      config = config_;
    }
  }

  void takeCalibrations() {
    rig_check_.emplace(params_.stereo);
    self_calibration_ = {};
    matchHeld();
  }

  void matchHeld() {
    while (!held_.empty() && cameras_->uncalibrated(held_.front()).empty()) {
      const ImageSet set = held_.front();
      held_.pop_front();
      match(set);
    }
  }

  void dropOldestHeld() {
    const std::string cause = cameras_->uncalibrated(held_.front());
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
    if (held_.size() > kMostHeld) dropOldestHeld();
  }

  void match(const ImageSet& set) {
    try {
      const ros::WallTime start = ros::WallTime::now();
      const TrinocularRig& rig = cameras_->rigOf(set);
      const StereoImages images = cameras_->imagesOf(set);
      requireUsable(images, rig);
      if (isWanted()) {
        matcher_->match(images, rig, disparity_);
        rig_check_->look(images, disparity_);
        if (!rig_check_->complaint().empty()) throw InputError(rig_check_->complaint());
        if (params_.self_calibration) self_calibration_.correct(images, disparity_);
        publish(images.reference, set.images[0]->header);
      }
      const bool third_is_missing = params_.third_camera && !set.images[2];
      diagnostics_->complain(third_is_missing ? cameras_->nameOf(2) + " is silent: two cameras go on alone"
                             : self_calibration_.isAtLimit()
                                 ? "the cameras are turned against their calibration: calibrate them again"
                                 : "");
      diagnostics_->processed((ros::WallTime::now() - start).toSec());
    } catch (const InputError& error) {
      diagnostics_->complain(error.what());
      diagnostics_->dropped(error.what());
    }
  }

  // About x, y and z, of camera 1 (right) or 2.
  std::string turnsOf(Eigen::Index camera) const {
    const SelfCalibration::Turns &turns_px = self_calibration_.turns_px(),
                                 sigmas_px = self_calibration_.sigmas_px();
    std::ostringstream text;
    text << std::fixed << std::setprecision(3);
    for (Eigen::Index i = 3 * (camera - 1); i < 3 * camera; ++i)
      text << turns_px(i) << " +- " << sigmas_px(i) << (i % 3 < 2 ? ", " : "");
    return text.str();
  }

  bool isWanted() const {
    const std::array publishers{&disparity_publisher_, &sigma_publisher_, &rejections_publisher_,
                                &picture_publisher_, &points_publisher_};
    return std::any_of(publishers.begin(), publishers.end(),
                       [](const ros::Publisher* publisher) { return publisher->getNumSubscribers() > 0; });
  }

  void publish(const cv::Mat1b& reference, const std_msgs::Header& header) {
    namespace encodings = sensor_msgs::image_encodings;
    const double searched_px = matcher_->largest_px(reference.size());
    if (disparity_publisher_.getNumSubscribers() > 0)
      disparity_publisher_.publish(toDisparityImage(disparity_, {0, searched_px}, header));
    if (sigma_publisher_.getNumSubscribers() > 0)
      sigma_publisher_.publish(toImage(disparity_.sigma_px, encodings::TYPE_32FC1, header));
    if (rejections_publisher_.getNumSubscribers() > 0)
      rejections_publisher_.publish(toImage(disparity_.rejection, encodings::MONO8, header));
    if (points_publisher_.getNumSubscribers() > 0)
      points_publisher_.publish(toPointCloud(disparity_, reference, header));
    if (picture_publisher_.getNumSubscribers() == 0) return;
    drawDisparity(disparity_.disparity_px, searched_px, picture_);
    picture_publisher_.publish(toImage(picture_, encodings::BGR8, header));
  }

  TrinocularStereoParams params_;
  std::optional<StereoMatcher> matcher_;
  std::optional<RigCheck> rig_check_;
  SelfCalibration self_calibration_;
  std::optional<StageDiagnostics> diagnostics_;
  std::optional<StereoCameras> cameras_;
  std::optional<ImageSets> sets_;
  std::deque<ImageSet> held_;  // complete sets that came before the calibrations, oldest first
  ros::WallTimer held_timer_;
  Disparity disparity_;
  cv::Mat3b picture_;
  ros::Publisher disparity_publisher_;
  ros::Publisher sigma_publisher_;
  ros::Publisher rejections_publisher_;
  ros::Publisher picture_publisher_;
  ros::Publisher points_publisher_;
  StereoConfig config_;  // what params_.stereo holds
  std::optional<dynamic_reconfigure::Server<StereoConfig>> reconfigure_;
};

std::unique_ptr<nodelet::Nodelet> makeTrinocularStereo() {
  return std::make_unique<TrinocularStereoNodelet>();
}

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::TrinocularStereoNodelet, nodelet::Nodelet)
