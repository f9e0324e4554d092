// Disparities as a cloud of points.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

// A point for each reference pixel, row by row as the image: x, y, z in m in the reference camera's optical
// frame and the pixel's brightness (0 to 255) as intensity. NaN where there is no answer, as PCL's organised
// clouds have it. `reference` is the rectified image of the same size.
sensor_msgs::PointCloud2Ptr toPointCloud(const Disparity& disparity, const cv::Mat1b& reference,
                                         const std_msgs::Header& header);

}  // namespace cornerstone
