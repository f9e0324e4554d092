// Range scans, laser scans and depth images between messages and the core.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>

#include "cornerstone/scan/depth_scan.h"
#include "cornerstone/scan/laser_scan.h"

namespace cornerstone {

// With the sensor's planar mounting; what the message leaves out (intensities, times) is not needed.
LaserRanges fromLaserScan(const sensor_msgs::LaserScan& message, const Pose2& base_from_sensor);

// The beams' ends as LaserScan wants them: on evenly spaced bearings, seen from the base frame's origin (the
// header's frame). A bearing without an answer is NaN, which says "no reading" (REP 117), never "free to the
// end".
sensor_msgs::LaserScan toLaserScan(const RangeScan& scan, const std_msgs::Header& header);

// 32FC1 in metres or 16UC1 in millimetres, with the camera's calibration. InputError naming the field at
// fault.
DepthImage fromDepthImage(const sensor_msgs::ImageConstPtr& message, const sensor_msgs::CameraInfo& info);

}  // namespace cornerstone
