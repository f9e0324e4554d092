// The cameras of a rig as they come over topics: the newest calibration of each, the rectification of raw
// images made from it, and the rig that the calibrations make together.
#pragma once

#include <ros/node_handle.h>

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "cornerstone/ros/nodelet_params.h"
#include "cornerstone/stereo/rectifier.h"
#include "nodelets/image_sets.h"

namespace cornerstone {

class StereoCameras {
 public:
  // `changed` is called after each calibration that is not the one before.
  StereoCameras(ros::NodeHandle& node, const TrinocularStereoParams& params, std::function<void()> changed);
  StereoCameras(const StereoCameras&) = delete;
  StereoCameras& operator=(const StereoCameras&) = delete;

  const std::string& nameOf(std::size_t camera) const { return cameras_[camera].name; }
  // What is said of the set's first camera without a calibration; empty: all have one.
  std::string uncalibrated(const ImageSet& set) const;
  // The rig of the set's cameras; InputError when their calibrations do not fit together.
  const TrinocularRig& rigOf(const ImageSet& set);
  // Grey and rectified, after rigOf; InputError naming the topic at fault.
  StereoImages imagesOf(const ImageSet& set);

 private:
  struct Camera {
    std::string name;
    ros::Subscriber info_subscriber;
    sensor_msgs::CameraInfo info;
    std::optional<CameraCalibration> calibration;
    std::optional<Rectifier> rectifier;
    cv::Mat1b rectified;  // kept, so that nothing is allocated image by image
  };

  void takeCalibration(Camera& camera, const sensor_msgs::CameraInfo& info);
  cv::Mat1b imageOf(Camera& camera, const sensor_msgs::ImageConstPtr& message);

  std::string images_;  // image_rect or image_raw
  std::function<void()> changed_;
  std::array<Camera, 3> cameras_;
  std::array<std::optional<TrinocularRig>, 2> rigs_;  // of two and of three cameras
};

}  // namespace cornerstone
