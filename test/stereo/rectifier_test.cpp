#include "cornerstone/stereo/rectifier.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

CameraCalibration camera() {
  CameraCalibration calibration;
  calibration.name = "left/camera_info";
  calibration.image_size_px = {40, 30};
  calibration.intrinsics_px << 50, 0, 20, 0, 50, 15, 0, 0, 1;
  calibration.rectification.setIdentity();
  calibration.projection_px << 50, 0, 20, 0, 0, 50, 15, 0, 0, 0, 1, 0;
  return calibration;
}

cv::Mat1b ramp() {  // grey level = 4 * column + row
  cv::Mat1b image(30, 40);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) image(y, x) = static_cast<std::uint8_t>(4 * x + y);
  return image;
}

TEST(Rectifier, LeavesAPerfectCameraAlone) {
  cv::Mat1b rectified;
  Rectifier(camera()).rectify(ramp(), rectified);
  EXPECT_EQ(cv::countNonZero(rectified != ramp()), 0);
}

TEST(Rectifier, MovesThePrincipalPoint) {
  CameraCalibration calibration = camera();
  calibration.projection_px(0, 2) = 22;  // what was seen at column 20 is now at 22
  cv::Mat1b rectified;
  Rectifier(calibration).rectify(ramp(), rectified);
  EXPECT_EQ(rectified(10, 22), ramp()(10, 20));
  EXPECT_EQ(rectified(10, 0), ramp()(10, 0));  // nothing was seen there: the nearest pixel
}

TEST(Rectifier, UndoesRadialDistortion) {
  CameraCalibration calibration = camera();
  calibration.distortion = {0.5, 0, 0, 0, 0};
  cv::Mat1b rectified;
  Rectifier(calibration).rectify(ramp(), rectified);
  // Column 30, row 15: x = 0.2, distorted to 0.2 (1 + 0.5 * 0.04) = 0.204, raw column 30.2, grey 4 * 30.2 +
  // 15 = 135.8.
  EXPECT_NEAR(rectified(15, 30), 135.8, 0.6);
}

TEST(Rectifier, RefusalsNameCameraAndField) {
  const auto refusalOf = [](const CameraCalibration& calibration) {
    try {
      Rectifier rectifier(calibration);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CameraCalibration no_focal = camera();
  no_focal.intrinsics_px.setZero();
  EXPECT_NE(refusalOf(no_focal).find("left/camera_info: focal length in K"), std::string::npos);
  CameraCalibration no_rotation = camera();
  no_rotation.rectification.setZero();
  EXPECT_NE(refusalOf(no_rotation).find("R is not a rotation"), std::string::npos);
  CameraCalibration odd = camera();
  odd.distortion = {0.1, 0.2, 0.3};
  EXPECT_NE(refusalOf(odd).find("D has 3 coefficients"), std::string::npos);
  cv::Mat1b rectified;
  EXPECT_THROW(Rectifier(camera()).rectify(cv::Mat1b(10, 10, std::uint8_t{0}), rectified), InputError);
}

}  // namespace
}  // namespace cornerstone
