#include "cornerstone/stereo/trinocular_rig.h"

#include <gtest/gtest.h>

#include <limits>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// f = 80 px, camera at (x, y) m in the reference image's axes (y down).
CameraCalibration cameraAt(const std::string& name, double x_m, double y_m) {
  CameraCalibration camera;
  camera.name = name;
  camera.image_size_px = {160, 120};
  camera.intrinsics_px << 80, 0, 80, 0, 80, 60, 0, 0, 1;
  camera.rectification.setIdentity();
  camera.projection_px << 80, 0, 80, -80 * x_m, 0, 80, 60, -80 * y_m, 0, 0, 1, 0;
  return camera;
}

std::string refusalOf(const CameraCalibration& reference, const CameraCalibration& right,
                      const std::optional<CameraCalibration>& top = {}) {
  try {
    makeRig(reference, right, top);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TrinocularRig, LShapeOfEqualBaselines) {
  const TrinocularRig rig =
      makeRig(cameraAt("reference", 0, 0), cameraAt("right", 0.12, 0), cameraAt("top", 0, -0.12));
  EXPECT_NEAR(rig.baseline_m, 0.12, 1e-12);
  EXPECT_NEAR(rig.focal_px, 80, 1e-12);
  EXPECT_NEAR(rig.rangeOf(3.2), 3.0, 1e-12);  // 80 * 0.12 / 3.2
  EXPECT_EQ(rig.right_shift, cv::Point2d(-1, 0));
  EXPECT_NEAR(rig.top_shift->x, 0, 1e-12);
  EXPECT_NEAR(rig.top_shift->y, 1, 1e-12);  // a top camera sees things lower in its image
}

TEST(TrinocularRig, ThirdCameraAnywhereAlongAnAxis) {
  const auto shiftOf = [](double x_m, double y_m) {
    return *makeRig(cameraAt("reference", 0, 0), cameraAt("right", 0.1, 0), cameraAt("third", x_m, y_m))
                .top_shift;
  };
  EXPECT_NEAR(shiftOf(0, 0.05).y, -0.5, 1e-12);  // bottom, half the baseline
  EXPECT_NEAR(shiftOf(-0.1, 0).x, 1, 1e-12);     // left
  EXPECT_NEAR(shiftOf(0.2, 0).x, -2, 1e-12);     // a second, wider right camera
}

TEST(TrinocularRig, TwoCamerasHaveNoTopShift) {
  EXPECT_FALSE(makeRig(cameraAt("reference", 0, 0), cameraAt("right", 0.12, 0), {}).top_shift);
}

TEST(TrinocularRig, RefusalsNameTheCamera) {
  const CameraCalibration reference = cameraAt("reference", 0, 0), right = cameraAt("right", 0.12, 0);
  CameraCalibration uncalibrated = right;
  uncalibrated.projection_px.setZero();
  EXPECT_NE(refusalOf(reference, uncalibrated).find("right: focal length"), std::string::npos);
  CameraCalibration broken = right;
  broken.projection_px(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusalOf(reference, broken).find("right: P holds NaN"), std::string::npos);
  CameraCalibration larger = right;
  larger.image_size_px = {320, 240};
  EXPECT_NE(refusalOf(reference, larger).find("right: image size"), std::string::npos);
  CameraCalibration longer = right;
  longer.projection_px(0, 0) = longer.projection_px(1, 1) = 81;
  EXPECT_NE(refusalOf(reference, longer).find("right: focal length in P differs"), std::string::npos);
  CameraCalibration off_centre = right;
  off_centre.projection_px(0, 2) += 1;
  EXPECT_NE(refusalOf(reference, off_centre).find("right: principal point"), std::string::npos);
}

TEST(TrinocularRig, RefusesBaselinesThatCannotBe) {
  const CameraCalibration reference = cameraAt("reference", 0, 0), right = cameraAt("right", 0.12, 0);
  EXPECT_NE(refusalOf(reference, cameraAt("right", 0, 0)).find("baseline is zero"), std::string::npos);
  EXPECT_NE(refusalOf(reference, cameraAt("right", -0.12, 0)).find("baseline is negative"),
            std::string::npos);
  EXPECT_NE(refusalOf(reference, cameraAt("right", 0, 0.12)).find("y axis"), std::string::npos);
  EXPECT_NE(refusalOf(reference, right, cameraAt("top", 0.1, -0.1)).find("top: baseline lies along neither"),
            std::string::npos);
  EXPECT_NE(refusalOf(reference, right, cameraAt("top", 0, 0)).find("top: baseline is zero"),
            std::string::npos);
}

}  // namespace
}  // namespace cornerstone
