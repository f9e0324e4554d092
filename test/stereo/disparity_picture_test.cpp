#include "cornerstone/stereo/disparity_picture.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

TEST(DisparityPicture, NearIsRedFarIsBlueNothingIsBlack) {
  const cv::Mat1f disparity_px = (cv::Mat1f(1, 3) << 0, 2, 31);
  cv::Mat3b picture;
  drawDisparity(disparity_px, 32, picture);
  EXPECT_EQ(picture(0, 0), cv::Vec3b(0, 0, 0));
  EXPECT_GT(picture(0, 1)[0], picture(0, 1)[2]);  // blue above red
  EXPECT_GT(picture(0, 2)[2], picture(0, 2)[0]);
}

}  // namespace
}  // namespace cornerstone
