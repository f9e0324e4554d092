#include "cornerstone/ros/point_messages.h"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>

namespace cornerstone {
namespace {

// Focal length 80 px, baseline 0.12 m: 4 px of disparity are 2.4 m.
Disparity oneAnswer(cv::Point at) {
  Disparity disparity;
  disparity.rig.image_size_px = {5, 3};
  disparity.rig.focal_px = 80;
  disparity.rig.baseline_m = 0.12;
  disparity.rig.centre_x_px = 2;
  disparity.rig.centre_y_px = 1;
  disparity.disparity_px = cv::Mat1f::zeros(3, 5);
  disparity.disparity_px(at) = 4;
  return disparity;
}

TEST(PointMessages, APixelIsWhereItsRayAndItsRangeSay) {
  std_msgs::Header header;
  header.frame_id = "a/reference_optical";
  header.stamp = ros::Time(7);
  cv::Mat1b reference(3, 5, uchar{100});
  reference(2, 4) = 201;
  const auto cloud = toPointCloud(oneAnswer({4, 2}), reference, header);
  EXPECT_EQ(cloud->header.frame_id, "a/reference_optical");
  EXPECT_EQ(cloud->header.stamp, ros::Time(7));
  EXPECT_EQ(cloud->width, 5U);
  EXPECT_EQ(cloud->height, 3U);
  EXPECT_EQ(cloud->row_step, 5 * cloud->point_step);
  ASSERT_EQ(cloud->data.size(), 3U * cloud->row_step);
  ASSERT_EQ(cloud->fields.size(), 4U);
  sensor_msgs::PointCloud2ConstIterator<float> point(*cloud, "x");
  sensor_msgs::PointCloud2ConstIterator<float> intensity(*cloud, "intensity");
  point += 2 * 5 + 4;
  intensity += 2 * 5 + 4;
  EXPECT_NEAR(point[0], 2 * 2.4 / 80, 1e-6);  // 2 px right of the centre
  EXPECT_NEAR(point[1], 1 * 2.4 / 80, 1e-6);  // 1 px below it
  EXPECT_NEAR(point[2], 2.4, 1e-6);
  EXPECT_EQ(*intensity, 201);
}

TEST(PointMessages, NoAnswerIsNoPoint) {
  const auto cloud = toPointCloud(oneAnswer({4, 2}), cv::Mat1b(3, 5, uchar{100}), {});
  EXPECT_FALSE(cloud->is_dense);
  sensor_msgs::PointCloud2ConstIterator<float> point(*cloud, "x");
  int points = 0;
  for (; point != point.end(); ++point) {
    const int numbers = std::isfinite(point[0]) + std::isfinite(point[1]) + std::isfinite(point[2]);
    EXPECT_EQ(numbers % 3, 0);
    points += numbers / 3;
  }
  EXPECT_EQ(points, 1);
}

}  // namespace
}  // namespace cornerstone
