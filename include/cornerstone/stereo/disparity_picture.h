// A disparity image for people: near is red, far is blue, no answer is black.
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

// `largest_px` is the reddest. The picture is reused from call to call.
void drawDisparity(const cv::Mat1f& disparity_px, double largest_px, cv::Mat3b& picture);

}  // namespace cornerstone
