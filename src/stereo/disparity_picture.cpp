#include "cornerstone/stereo/disparity_picture.h"

#include <opencv2/imgproc.hpp>

namespace cornerstone {

void drawDisparity(const cv::Mat1f& disparity_px, double largest_px, cv::Mat3b& picture) {
  cv::Mat1b scaled;
  disparity_px.convertTo(scaled, CV_8U, 255 / largest_px);
  cv::applyColorMap(scaled, picture, cv::COLORMAP_JET);
  picture.setTo(cv::Vec3b(0, 0, 0), disparity_px <= 0);
}

}  // namespace cornerstone
