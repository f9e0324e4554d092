// Rendered boards with known lenses and mounting: an L of three cameras.
#include "cornerstone/stereo/rig_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/stereo/trinocular_rig.h"

namespace cornerstone {
namespace {

const cv::Size kSize(320, 240);
const Chessboard kBoard{{8, 6}, 0.04};

struct TrueCamera {
  Eigen::Isometry3d reference_from_camera = Eigen::Isometry3d::Identity();
  double focal_px = 250, radial = -0.12;  // distortion: r (1 + radial r^2)
};

Eigen::Isometry3d poseOf(const Eigen::Vector3d& at_m, const Eigen::Vector3d& turn_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = at_m;
  if (turn_rad.norm() > 0)
    pose.linear() = Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix();
  return pose;
}

std::vector<TrueCamera> trueRig() {
  std::vector<TrueCamera> cameras(3);
  cameras[1].reference_from_camera = poseOf({0.12, 0.001, 0.002}, {0.004, -0.01, 0.006});
  cameras[1].focal_px = 252;
  cameras[2].reference_from_camera = poseOf({0.0005, -0.12, 0}, {-0.008, 0.003, -0.005});
  cameras[2].focal_px = 248;
  return cameras;
}

Eigen::Vector2d undistorted(const Eigen::Vector2d& distorted, double radial) {
  Eigen::Vector2d plain = distorted;
  for (int i = 0; i < 6; ++i) plain = distorted / (1 + radial * plain.squaredNorm());
  return plain;
}

// Grey level of a point of the board's plane: squares around the inner corners, white around them.
double greyAt(double x_m, double y_m) {
  const int col = static_cast<int>(std::floor(x_m / kBoard.square_m)) + 1,
            row = static_cast<int>(std::floor(y_m / kBoard.square_m)) + 1;
  if (col < 0 || row < 0 || col > kBoard.inner_corners.width || row > kBoard.inner_corners.height) return 220;
  return (col + row) % 2 == 0 ? 30 : 220;
}

cv::Mat1b rendered(const TrueCamera& camera, const Eigen::Isometry3d& reference_from_board) {
  constexpr int kSamples = 2;
  const Eigen::Isometry3d board_from_camera = reference_from_board.inverse() * camera.reference_from_camera;
  cv::Mat1b image(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      double sum = 0;
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const Eigen::Vector2d at((x + (s % kSamples + 0.5) / kSamples - 0.5 - 160) / camera.focal_px,
                                 (y + (s / kSamples + 0.5) / kSamples - 0.5 - 120) / camera.focal_px);
        const Eigen::Vector3d ray = board_from_camera.linear() * undistorted(at, camera.radial).homogeneous();
        const Eigen::Vector3d hit =
            board_from_camera.translation() - ray * (board_from_camera.translation().z() / ray.z());
        sum += greyAt(hit.x(), hit.y());
      }
      image(y, x) = static_cast<std::uint8_t>(std::lround(sum / (kSamples * kSamples)));
    }
  }
  return image;
}

// The board at different distances, places and tilts, seen by all.
std::vector<CameraViews> viewsOf(const std::vector<TrueCamera>& cameras, int sets) {
  cv::RNG random(3);
  std::vector<CameraViews> views(cameras.size());
  const char* names[] = {"reference", "right", "top"};
  for (std::size_t i = 0; i < cameras.size(); ++i) views[i].name = names[i];
  for (int set = 0; set < sets; ++set) {
    const Eigen::Vector3d turn(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                               random.uniform(-0.2, 0.2));
    const Eigen::Isometry3d reference_from_board =
        poseOf({random.uniform(-0.22, 0.0), random.uniform(-0.2, -0.05), random.uniform(0.55, 0.8)}, turn);
    for (std::size_t i = 0; i < cameras.size(); ++i)
      views[i].corners.push_back(findCorners(rendered(cameras[i], reference_from_board), kBoard));
  }
  return views;
}

TEST(RigCalibration, FindsLensesAndMountingOfThreeCameras) {
  const std::vector<TrueCamera> truth = trueRig();
  std::string why;
  const auto rig = calibrateRig(viewsOf(truth, 14), kSize, kBoard, why);
  ASSERT_TRUE(rig) << why;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const CameraCalibration& camera = rig->cameras[i];
    EXPECT_LT(rig->rms_px[i], 0.15) << camera.name;
    EXPECT_NEAR(camera.intrinsics_px(0, 0), truth[i].focal_px, 3) << camera.name;
    EXPECT_NEAR(camera.intrinsics_px(0, 2), 160, 2) << camera.name;
    EXPECT_NEAR(camera.distortion[0], truth[i].radial, 0.03) << camera.name;
  }
  for (const PairReport& pair : rig->pairs) {
    EXPECT_NEAR(pair.baseline_m, 0.12, 0.0006) << pair.name;
    EXPECT_LT(pair.epipolar_rms_px, 0.3) << pair.name;
    EXPECT_GE(pair.sets, 10) << pair.name;
  }
  const TrinocularRig geometry = makeRig(rig->cameras[0], rig->cameras[1], rig->cameras[2]);
  EXPECT_NEAR(geometry.baseline_m, 0.12, 0.0006);
  EXPECT_NEAR(geometry.focal_px, 250, 2);
  EXPECT_NEAR(geometry.top_shift->y, 1, 0.01);
}

TEST(RigCalibration, TwoCamerasWillDo) {
  std::vector<TrueCamera> truth = trueRig();
  truth.pop_back();
  std::string why;
  const auto rig = calibrateRig(viewsOf(truth, 7), kSize, kBoard, why);
  ASSERT_TRUE(rig) << why;
  EXPECT_NEAR(makeRig(rig->cameras[0], rig->cameras[1], {}).baseline_m, 0.12, 0.001);
}

TEST(RigCalibration, RefusesWhatContradicts) {
  std::vector<TrueCamera> truth = trueRig();
  truth.pop_back();
  std::vector<CameraViews> views = viewsOf(truth, 7);
  std::string why;
  // Images of different instants: the board has moved.
  std::vector<CameraViews> unsynchronised = views;
  std::rotate(unsynchronised[1].corners.begin(), unsynchronised[1].corners.begin() + 1,
              unsynchronised[1].corners.end());
  EXPECT_FALSE(calibrateRig(unsynchronised, kSize, kBoard, why));
  EXPECT_NE(why.find("reference and right"), std::string::npos) << why;
  // Too few boards.
  for (std::size_t i = 3; i < 7; ++i) views[1].corners[i].clear();
  EXPECT_THROW(calibrateRig(views, kSize, kBoard, why), InputError);
  views[1].corners.pop_back();
  EXPECT_THROW(calibrateRig(views, kSize, kBoard, why), InputError);
  EXPECT_THROW(calibrateRig({views[0]}, kSize, kBoard, why), InputError);
}

TEST(Chessboard, NoBoardNoCorners) {
  EXPECT_TRUE(findCorners(cv::Mat1b(kSize, 128), kBoard).empty());
  EXPECT_THROW(requireUsable({{2, 6}, 0.04}), InputError);
  EXPECT_THROW(requireUsable({{8, 6}, 0}), InputError);
}

}  // namespace
}  // namespace cornerstone
