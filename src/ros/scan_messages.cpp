#include "cornerstone/ros/scan_messages.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cornerstone/base/errors.h"

namespace cornerstone {

LaserRanges fromLaserScan(const sensor_msgs::LaserScan& message, const Pose2& base_from_sensor) {
  LaserRanges laser;
  laser.ranges_m = message.ranges;
  laser.angle_min_rad = message.angle_min;
  laser.angle_increment_rad = message.angle_increment;
  laser.range_min_m = message.range_min;
  laser.range_max_m = message.range_max;
  laser.base_from_sensor = base_from_sensor;
  return laser;
}

sensor_msgs::LaserScan toLaserScan(const RangeScan& scan, const std_msgs::Header& header) {
  sensor_msgs::LaserScan message;
  message.header = header;
  if (scan.beams.size() < 2) return message;
  const auto [first, last] =
      std::minmax_element(scan.beams.begin(), scan.beams.end(),
                          [](const Beam& a, const Beam& b) { return a.bearing_rad < b.bearing_rad; });
  const double step_rad =
      (last->bearing_rad - first->bearing_rad) / static_cast<double>(scan.beams.size() - 1);
  const double start_rad = first->bearing_rad + scan.base_from_sensor.yaw_rad;
  message.angle_min = static_cast<float>(start_rad);
  message.angle_max = static_cast<float>(last->bearing_rad + scan.base_from_sensor.yaw_rad);
  message.angle_increment = static_cast<float>(step_rad);
  message.range_max = std::numeric_limits<float>::max();
  message.ranges.assign(scan.beams.size(), std::numeric_limits<float>::quiet_NaN());
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    const Eigen::Vector2d point_m =
        scan.base_from_sensor *
        Eigen::Vector2d(beam.range_m * std::cos(beam.bearing_rad), beam.range_m * std::sin(beam.bearing_rad));
    const auto bin = std::lround(wrapAngle(std::atan2(point_m.y(), point_m.x()) - start_rad) / step_rad);
    if (bin < 0 || bin >= static_cast<long>(message.ranges.size())) continue;
    // The nearer of two beams on one bearing stays.
    float& range = message.ranges[static_cast<std::size_t>(bin)];
    range = std::fmin(range, static_cast<float>(point_m.norm()));
  }
  return message;
}

DepthImage fromDepthImage(const sensor_msgs::ImageConstPtr& message, const sensor_msgs::CameraInfo& info) {
  namespace encodings = sensor_msgs::image_encodings;
  if (message->encoding != encodings::TYPE_32FC1 && message->encoding != encodings::TYPE_16UC1)
    throw InputError("depth: encoding is '" + message->encoding + "', it must be 32FC1 or 16UC1");
  if (info.width != message->width) throw InputError("camera_info: width is not that of the depth image");
  requirePositive(info.P[0], "camera_info: P[0]");
  DepthImage image;
  try {
    image.depth = cv_bridge::toCvCopy(message)->image;
  } catch (const std::exception& error) {
    throw InputError(std::string("depth: ") + error.what());
  }
  image.focal_px = info.P[0];
  image.centre_x_px = info.P[2];
  image.centre_y_px = info.P[6];
  return image;
}

}  // namespace cornerstone
