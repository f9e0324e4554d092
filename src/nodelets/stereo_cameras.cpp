#include "nodelets/stereo_cameras.h"

#include "cornerstone/ros/image_messages.h"

namespace cornerstone {
namespace {

std::size_t cameraCount(const ImageSet& set) { return set.images[2] ? 3 : 2; }

}  // namespace

StereoCameras::StereoCameras(ros::NodeHandle& node, const TrinocularStereoParams& params,
                             std::function<void()> changed)
    : images_(params.images), changed_(std::move(changed)) {
  for (std::size_t i = 0; i < (params.third_camera ? 3 : 2); ++i) {
    Camera& camera = cameras_[i];
    camera.name = node.resolveName(kCameras[i]);
    camera.info_subscriber = node.subscribe<sensor_msgs::CameraInfo>(
        std::string(kCameras[i]) + "/camera_info", 1,
        [this, &camera](const sensor_msgs::CameraInfoConstPtr& info) { takeCalibration(camera, *info); });
  }
}

void StereoCameras::takeCalibration(Camera& camera, const sensor_msgs::CameraInfo& info) {
  sensor_msgs::CameraInfo unstamped = info;
  unstamped.header = camera.info.header;
  if (camera.calibration && unstamped == camera.info) return;
  camera.info = unstamped;
  camera.calibration = toCalibration(info, camera.name + "/camera_info");
  camera.rectifier.reset();
  for (auto& rig : rigs_) rig.reset();
  changed_();
}

std::string StereoCameras::uncalibrated(const ImageSet& set) const {
  for (std::size_t i = 0; i < cameraCount(set); ++i)
    if (!cameras_[i].calibration) return cameras_[i].name + "/camera_info: none received yet";
  return {};
}

const TrinocularRig& StereoCameras::rigOf(const ImageSet& set) {
  const std::size_t count = cameraCount(set);
  std::optional<TrinocularRig>& rig = rigs_[count - 2];
  if (rig) return *rig;
  if (images_ == "image_raw")
    for (std::size_t i = 0; i < count; ++i)
      if (!cameras_[i].rectifier) cameras_[i].rectifier.emplace(*cameras_[i].calibration);
  rig = makeRig(*cameras_[0].calibration, *cameras_[1].calibration,
                count > 2 ? cameras_[2].calibration : std::nullopt);
  return *rig;
}

StereoImages StereoCameras::imagesOf(const ImageSet& set) {
  return {imageOf(cameras_[0], set.images[0]), imageOf(cameras_[1], set.images[1]),
          imageOf(cameras_[2], set.images[2])};
}

cv::Mat1b StereoCameras::imageOf(Camera& camera, const sensor_msgs::ImageConstPtr& message) {
  if (!message) return {};
  const cv::Mat1b grey = toGrey(message, camera.name + "/" + images_);
  if (!camera.rectifier) return grey;
  camera.rectifier->rectify(grey, camera.rectified);
  return camera.rectified;
}

}  // namespace cornerstone
