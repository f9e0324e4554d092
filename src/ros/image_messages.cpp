#include "cornerstone/ros/image_messages.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "cornerstone/base/errors.h"

namespace cornerstone {

cv::Mat1b toGrey(const sensor_msgs::ImageConstPtr& image, const std::string& topic) {
  if (image->width == 0 || image->height == 0) throw InputError(topic + ": the image is empty");
  if (image->data.size() < static_cast<std::size_t>(image->step) * image->height)
    throw InputError(topic + ": the image is truncated");
  try {
    return cv_bridge::toCvShare(image, sensor_msgs::image_encodings::MONO8)->image;
  } catch (const std::exception& error) {
    throw InputError(topic + ": encoding '" + image->encoding +
                     "' is no image that turns grey: " + error.what());
  }
}

CameraCalibration toCalibration(const sensor_msgs::CameraInfo& info, const std::string& topic) {
  CameraCalibration calibration;
  calibration.name = topic;
  calibration.image_size_px = {static_cast<int>(info.width), static_cast<int>(info.height)};
  calibration.distortion = info.D;
  std::copy(info.K.begin(), info.K.end(), calibration.intrinsics_px.reshaped<Eigen::RowMajor>().begin());
  std::copy(info.R.begin(), info.R.end(), calibration.rectification.reshaped<Eigen::RowMajor>().begin());
  std::copy(info.P.begin(), info.P.end(), calibration.projection_px.reshaped<Eigen::RowMajor>().begin());
  return calibration;
}

sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration, const std_msgs::Header& header) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<unsigned>(calibration.image_size_px.width);
  info.height = static_cast<unsigned>(calibration.image_size_px.height);
  info.distortion_model = "plumb_bob";
  info.D = calibration.distortion;
  const auto k = calibration.intrinsics_px.reshaped<Eigen::RowMajor>();
  const auto r = calibration.rectification.reshaped<Eigen::RowMajor>();
  const auto p = calibration.projection_px.reshaped<Eigen::RowMajor>();
  std::copy(k.begin(), k.end(), info.K.begin());
  std::copy(r.begin(), r.end(), info.R.begin());
  std::copy(p.begin(), p.end(), info.P.begin());
  return info;
}

sensor_msgs::ImagePtr toImage(const cv::Mat& image, const std::string& encoding,
                              const std_msgs::Header& header) {
  return cv_bridge::CvImage(header, encoding, image).toImageMsg();
}

stereo_msgs::DisparityImagePtr toDisparityImage(const Disparity& disparity, const DisparityRange& searched,
                                                const std_msgs::Header& header) {
  auto message = boost::make_shared<stereo_msgs::DisparityImage>();
  message->header = header;
  cv_bridge::CvImage(header, sensor_msgs::image_encodings::TYPE_32FC1, disparity.disparity_px)
      .toImageMsg(message->image);
  message->f = static_cast<float>(disparity.rig.focal_px);
  message->T = static_cast<float>(disparity.rig.baseline_m);
  message->valid_window.width = message->image.width;
  message->valid_window.height = message->image.height;
  message->min_disparity = static_cast<float>(searched.min_px);
  message->max_disparity = static_cast<float>(searched.max_px);
  message->delta_d = 1.0f / 16;
  return message;
}

cv::Mat1f floatImage(const sensor_msgs::Image& message, const std::string& name) {
  if (message.encoding != sensor_msgs::image_encodings::TYPE_32FC1)
    throw InputError(name + ": encoding is '" + message.encoding + "', it must be 32FC1");
  try {
    return cv_bridge::toCvCopy(message)->image;
  } catch (const std::exception& error) {
    throw InputError(name + ": " + error.what());
  }
}

Disparity fromDisparityImage(const stereo_msgs::DisparityImage& message, const sensor_msgs::CameraInfo& info,
                             const cv::Mat1f& sigma_px) {
  requirePositive(message.f, "disparity: f");
  requirePositive(message.T, "disparity: T");
  requirePositive(info.P[0], "camera_info: P[0]");
  Disparity disparity;
  disparity.disparity_px = floatImage(message.image, "disparity: image");
  // Other stereo nodes mark missing answers by values below min_disparity or by NaN.
  disparity.disparity_px.setTo(0, ~(disparity.disparity_px > std::max(0.f, message.min_disparity)));
  disparity.sigma_px = sigma_px;
  if (sigma_px.size() != disparity.disparity_px.size())
    throw InputError("disparity_sigma: its size is not disparity's");
  disparity.rig.image_size_px = disparity.disparity_px.size();
  disparity.rig.focal_px = message.f;
  disparity.rig.baseline_m = message.T;
  disparity.rig.centre_x_px = info.P[2];
  disparity.rig.centre_y_px = info.P[6];
  if (static_cast<int>(info.width) != disparity.disparity_px.cols)
    throw InputError("camera_info: width is not that of the disparity image");
  return disparity;
}

}  // namespace cornerstone
