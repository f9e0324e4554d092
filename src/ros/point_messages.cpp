#include "cornerstone/ros/point_messages.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <boost/make_shared.hpp>
#include <limits>

namespace cornerstone {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

sensor_msgs::PointCloud2Ptr emptyCloud(cv::Size size, const std_msgs::Header& header) {
  const auto float32 = sensor_msgs::PointField::FLOAT32;
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  sensor_msgs::PointCloud2Modifier(*cloud).setPointCloud2Fields(4, "x", 1, float32, "y", 1, float32, "z", 1,
                                                                float32, "intensity", 1, float32);
  cloud->header = header;
  cloud->width = static_cast<unsigned>(size.width);
  cloud->height = static_cast<unsigned>(size.height);
  cloud->row_step = cloud->width * cloud->point_step;
  cloud->data.resize(std::size_t{cloud->row_step} * cloud->height);
  cloud->is_dense = false;
  return cloud;
}

}  // namespace

sensor_msgs::PointCloud2Ptr toPointCloud(const Disparity& disparity, const cv::Mat1b& reference,
                                         const std_msgs::Header& header) {
  auto cloud = emptyCloud(disparity.disparity_px.size(), header);
  sensor_msgs::PointCloud2Iterator<float> out(*cloud, "x");
  for (int row = 0; row < disparity.disparity_px.rows; ++row)
    for (int col = 0; col < disparity.disparity_px.cols; ++col, ++out) {
      const float disparity_px = disparity.disparity_px(row, col);
      Eigen::Vector3d point = Eigen::Vector3d::Constant(kNone);
      if (disparity_px > 0) point = disparity.rig.pointOf(col, row, disparity_px);
      for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(point[i]);
      out[3] = reference(row, col);
    }
  return cloud;
}

}  // namespace cornerstone
