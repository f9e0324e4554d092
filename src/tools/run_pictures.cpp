#include "tools/run_pictures.h"

#include <cv_bridge/cv_bridge.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <stereo_msgs/DisparityImage.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/occupancy_grid.h"
#include "cornerstone/ros/image_messages.h"
#include "cornerstone/ros/transforms.h"
#include "cornerstone/scan/column_scan.h"
#include "cornerstone/simulation/true_surfaces.h"
#include "tools/drawing.h"
#include "tools/run_metrics.h"

namespace cornerstone {
namespace {

constexpr int kZoom = 2;          // of the camera's images
constexpr double kDeepest_m = 8;  // of the depth plot
constexpr float kPlotSigma_px =
    0.1f;  // for the view from above: a typical pixel's, the bag does not hold sigma

struct Frame {
  cv::Mat1b grey;
  Disparity disparity;
  std::string frame_id;
};

Frame readFrame(const std::string& path, const std::string& robot, double time_s) {
  const rosbag::Bag bag(path);
  const std::vector<std::string> topics{"/" + robot + "/reference/image_rect", "/" + robot + "/disparity"};
  // Both are recorded in any order: the first stamp that both have counts.
  std::map<ros::Time, sensor_msgs::ImageConstPtr> images;
  std::map<ros::Time, stereo_msgs::DisparityImageConstPtr> disparities;
  for (const auto& message : rosbag::View(bag, rosbag::TopicQuery(topics))) {
    if (const auto image = message.instantiate<sensor_msgs::Image>()) images[image->header.stamp] = image;
    if (const auto found = message.instantiate<stereo_msgs::DisparityImage>())
      disparities[found->header.stamp] = found;
  }
  for (const auto& [stamp, image] : images) {
    if (stamp.toSec() < time_s || disparities.count(stamp) == 0) continue;
    const auto& disparity = disparities.at(stamp);
    Frame frame;
    frame.grey = cv_bridge::toCvCopy(image, "mono8")->image;
    sensor_msgs::CameraInfo info;  // the simulated rig's principal point is the middle of the image
    info.width = image->width;
    info.P[0] = disparity->f;
    info.P[2] = (image->width - 1) / 2.0;
    info.P[6] = (image->height - 1) / 2.0;
    frame.disparity = fromDisparityImage(*disparity, info, cv::Mat1f(frame.grey.size(), kPlotSigma_px));
    frame.frame_id = disparity->header.frame_id;
    return frame;
  }
  throw InputError(path + ": no image and disparity of robot " + robot + " at " + std::to_string(time_s) +
                   " s");
}

cv::Mat3b enlarged(const cv::Mat& image) {
  cv::Mat coloured;
  if (image.channels() == 1)
    cv::cvtColor(image, coloured, cv::COLOR_GRAY2BGR);
  else
    coloured = image;
  cv::resize(coloured, coloured, {}, kZoom, kZoom, cv::INTER_NEAREST);
  return coloured;
}

// White: no answer; otherwise brighter is nearer, as in the paper.
cv::Mat3b pictureOfDisparity(const cv::Mat1f& disparity_px) {
  double largest_px = 0;
  cv::minMaxLoc(disparity_px, nullptr, &largest_px);
  cv::Mat1b grey;
  disparity_px.convertTo(grey, CV_8U, 230 / std::max(largest_px, 1.0));
  grey.setTo(255, disparity_px <= 0);
  return enlarged(grey);
}

// Columns of bars from below; `share` of the height for each column.
cv::Mat3b plotColumns(const std::vector<double>& shares, cv::Size size) {
  cv::Mat3b plot(size, cv::Vec3b(255, 255, 255));
  const double width = size.width / static_cast<double>(shares.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const int height = static_cast<int>(std::lround(std::min(shares[i], 1.0) * size.height));
    const int left = static_cast<int>(std::lround(static_cast<double>(i) * width));
    cv::rectangle(plot, {left, size.height - height}, {left + static_cast<int>(width) - 1, size.height - 1},
                  {120, 60, 20}, cv::FILLED);
  }
  return plot;
}

cv::Mat3b viewFromAbove(const RangeScan& scan, cv::Size size) {
  OccupancyGrid grid{GridParams{}};
  grid.insert(scan, Pose2{});
  if (grid.empty()) return cv::Mat3b(size, cv::Vec3b(127, 127, 127));
  const GridMap map = grid.snapshot();
  Canvas canvas = Canvas::over({{&map, Pose2{0, 0, M_PI / 2}}}, std::max(size.width, size.height));
  drawMap(canvas, map, Pose2{0, 0, M_PI / 2});
  cv::Mat3b fitted(size, cv::Vec3b(127, 127, 127));
  const double zoom =
      std::min(size.width / double(canvas.image.cols), size.height / double(canvas.image.rows));
  cv::Mat3b small;
  cv::resize(canvas.image, small, {}, zoom, zoom, cv::INTER_AREA);
  small.copyTo(fitted(cv::Rect(0, 0, small.cols, small.rows)));
  return fitted;
}

}  // namespace

cv::Mat3b pictureOfOneFrame(const std::string& bag, const std::string& robot, double time_s) {
  const Frame frame = readFrame(bag, robot, time_s);
  const RunRecording run = readRun(bag);
  const auto base_from_camera = lookUp(*run.tf, robot + "/base_link", frame.frame_id, ros::Time(0));
  if (!base_from_camera) throw InputError(bag + ": no tf from " + robot + "/base_link to " + frame.frame_id);
  const RangeScan scan = scanFromDisparity(frame.disparity, *base_from_camera, ScanParams{});

  std::vector<double> disparities, depths;
  for (int col = 0; col < frame.disparity.disparity_px.cols; ++col) {
    double largest_px = 0;
    cv::minMaxLoc(frame.disparity.disparity_px.col(col), nullptr, &largest_px);
    disparities.push_back(largest_px);
    depths.push_back(0);
  }
  const double top_px = std::max(1.0, *std::max_element(disparities.begin(), disparities.end()));
  for (double& disparity : disparities) disparity /= top_px;
  // Beams rise in bearing, which is from the image's right to its left.
  for (std::size_t i = 0; i < scan.beams.size(); ++i)
    if (scan.beams[i].hit) depths[depths.size() - 1 - i] = scan.beams[i].range_m / kDeepest_m;
  const cv::Mat3b grey = enlarged(frame.grey);
  cv::Mat3b sheet;
  cv::hconcat(std::vector<cv::Mat>{grey, pictureOfDisparity(frame.disparity.disparity_px),
                                   plotColumns(disparities, grey.size()), plotColumns(depths, grey.size()),
                                   viewFromAbove(scan, grey.size())},
              sheet);
  return sheet;
}

cv::Mat3b pictureOfMapAndTruth(const RunRecording& run, const std::string& robot) {
  const GridMap& map = run.robots.at(robot).map;
  const auto world_from_map = worldFromMap(run, robot, Placement::kTrajectory);
  if (map.occupied.empty() || run.world_yaml.empty() || !world_from_map) return {};
  Canvas canvas = Canvas::over({{&map, *world_from_map}});
  drawMap(canvas, map, *world_from_map);
  const TrueSurfaces surfaces(solidsOf(parseWorld(run.world_yaml, run.path + ": /world", ".")));
  for (const Eigen::Vector2d& point : surfaces.points())
    cv::circle(canvas.image, canvas.at(point), 0, cv::Scalar(0, 0, 255), cv::FILLED);
  return canvas.image;
}

}  // namespace cornerstone
