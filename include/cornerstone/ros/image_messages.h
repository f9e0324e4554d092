// Images, calibrations and disparities between messages and the core.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <stereo_msgs/DisparityImage.h>

#include <opencv2/core.hpp>
#include <string>

#include "cornerstone/stereo/calibration.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

// Grey image; it shares the message's memory where the encoding is mono8 already. InputError naming `topic`
// when the encoding is not an 8-bit or 16-bit image or the sizes do not fit the data.
cv::Mat1b toGrey(const sensor_msgs::ImageConstPtr& image, const std::string& topic);

// `topic` becomes the calibration's name. No check here: makeRig refuses what is no calibration.
CameraCalibration toCalibration(const sensor_msgs::CameraInfo& info, const std::string& topic);
sensor_msgs::CameraInfo toCameraInfo(const CameraCalibration& calibration, const std_msgs::Header& header);

sensor_msgs::ImagePtr toImage(const cv::Mat& image, const std::string& encoding,
                              const std_msgs::Header& header);

struct DisparityRange {
  double min_px;
  double max_px;
};
stereo_msgs::DisparityImagePtr toDisparityImage(const Disparity& disparity, const DisparityRange& searched,
                                                const std_msgs::Header& header);

// A copy of a 32FC1 image; InputError naming `name` when it is none.
cv::Mat1f floatImage(const sensor_msgs::Image& message, const std::string& name);

// The disparity of another node's message: the principal point comes from the reference camera's calibration,
// the standard deviation from `sigma` (32FC1, same size). InputError naming the field at fault.
Disparity fromDisparityImage(const stereo_msgs::DisparityImage& message, const sensor_msgs::CameraInfo& info,
                             const cv::Mat1f& sigma_px);

}  // namespace cornerstone
