#include "cornerstone/simulation/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "cornerstone/simulation/camera_rig.h"

namespace cornerstone {
namespace {

// An empty hall with one dark board of 0.2 m x 0.3 m, standing 2 m before the origin, its centre at y = 0.3,
// z = 0.5.
const char* kHall = R"(
name: hall
seed: 3
extent_m: [-9, -9, 9, 9]
ceiling_m: 3
walls:
  - {points_m: [[4, -8], [4, 8]], height_m: 3, thickness_m: 0.2, material: paint}
boxes:
  - {at_m: [2.01, 0.3], yaw_deg: 0, size_m: [0.02, 0.2, 0.3], z_m: 0.65, material: metal}
robots: []
)";

struct Edges {
  double left, right, top, bottom;
};

// A pixel that an edge crosses is darkened by the share of its area that is dark: the sum of these shares
// across the edge tells where it lies, to a fraction of a pixel. `outside` and `inside` are 3 px from it;
// pixels count from their centres.
double edgeBetween(const cv::Mat1f& profile, int outside, int inside) {
  const double bright = profile(outside), dark = profile(inside);
  double shares = 0;
  for (int i = std::min(outside, inside); i <= std::max(outside, inside); ++i)
    shares += std::clamp((profile(i) - dark) / (bright - dark), 0.0, 1.0);
  return outside < inside ? outside - 0.5 + shares : outside + 0.5 - shares;
}

Edges edgesOf(const cv::Mat1f& image) {
  cv::Mat1b dark;
  cv::compare(image, 125, dark, cv::CMP_LT);
  // Between skirting and ceiling there is nothing dark but the board.
  dark.rowRange(62, dark.rows).setTo(0);
  const cv::Rect box = cv::boundingRect(dark);
  const cv::Rect middle(box.x + 2, box.y + 2, box.width - 4, box.height - 4);
  cv::Mat1f along_x, along_y;
  cv::reduce(image.rowRange(middle.y, middle.br().y), along_x, 0, cv::REDUCE_AVG);
  cv::reduce(image.colRange(middle.x, middle.br().x), along_y, 1, cv::REDUCE_AVG);
  return {edgeBetween(along_x, box.x - 3, box.x + 2), edgeBetween(along_x, box.br().x + 2, box.br().x - 3),
          edgeBetween(along_y, box.y - 3, box.y + 2), edgeBetween(along_y, box.br().y + 2, box.br().y - 3)};
}

Eigen::Vector2d project(const Eigen::Vector3d& point_m, const Eigen::Isometry3d& world_from_camera,
                        const CameraCalibration& camera) {
  const Eigen::Vector3d seen = camera.intrinsics_px * (world_from_camera.inverse() * point_m);
  return seen.head<2>() / seen.z();
}

class RendererTest : public testing::Test {
 protected:
  // 8: edges fall on whole samples, so that they are exact to 1/16 px only.
  static RendererSetup setup() {
    const RigParams rig;
    return {{rig.width_px, rig.height_px},
            focalLength(rig),
            (rig.width_px - 1) / 2.0,
            (rig.height_px - 1) / 2.0,
            8};
  }
  World world_ = parseWorld(kHall, "hall", ".");
  Renderer renderer_{world_, {}, setup()};
  std::array<Eigen::Isometry3d, kCameraCount> cameras_ = baseFromCameras(RigParams{});
  std::array<CameraCalibration, kCameraCount> calibrations_ = calibrationsOf(RigParams{});
};

TEST_F(RendererTest, KnownPointsLieWhereThePinholeProjectsThem) {
  for (std::size_t camera = 0; camera < kCameraCount; ++camera) {
    const Edges edges = edgesOf(renderer_.render(cameras_[camera]));
    const Eigen::Vector2d top_left = project({2, 0.4, 0.95}, cameras_[camera], calibrations_[camera]);
    const Eigen::Vector2d bottom_right = project({2, 0.2, 0.65}, cameras_[camera], calibrations_[camera]);
    EXPECT_NEAR(edges.left, top_left.x(), 0.1) << kCameraNames[camera];
    EXPECT_NEAR(edges.top, top_left.y(), 0.1) << kCameraNames[camera];
    EXPECT_NEAR(edges.right, bottom_right.x(), 0.1) << kCameraNames[camera];
    EXPECT_NEAR(edges.bottom, bottom_right.y(), 0.1) << kCameraNames[camera];
  }
}

// f = 80 px, B = 0.12 m, Z = 2 m: d = 4.8 px. Right sees a reference pixel (x, y) at (x - d, y), top at (x, y
// + d).
TEST_F(RendererTest, DisparityIsFocalLengthTimesBaselineOverRange) {
  const Edges reference = edgesOf(renderer_.render(cameras_[0]));
  const Edges right = edgesOf(renderer_.render(cameras_[1]));
  const Edges top = edgesOf(renderer_.render(cameras_[2]));
  EXPECT_NEAR(reference.left - right.left, 4.8, 0.1);
  EXPECT_NEAR(reference.right - right.right, 4.8, 0.1);
  EXPECT_NEAR(reference.top - right.top, 0, 0.1);
  EXPECT_NEAR(top.top - reference.top, 4.8, 0.1);
  EXPECT_NEAR(top.bottom - reference.bottom, 4.8, 0.1);
  EXPECT_NEAR(top.left - reference.left, 0, 0.1);
}

TEST_F(RendererTest, DepthIsAlongTheOpticalAxis) {
  const cv::Mat1f depth_m = renderer_.renderDepth(cameras_[0]);
  EXPECT_NEAR(depth_m(60, 10), 3.9, 0.01);  // the wall's face, oblique: still Z
  EXPECT_NEAR(depth_m(43, 67), 2.0, 0.01);  // the board
}

TEST_F(RendererTest, SameViewSameBytes) {
  const cv::Mat1f first = renderer_.render(cameras_[0]);
  renderer_.render(cameras_[1]);
  EXPECT_EQ(cv::norm(first, renderer_.render(cameras_[0]), cv::NORM_INF), 0);
}

TEST_F(RendererTest, WallsHaveFaintTexture) {
  const cv::Mat1f image = renderer_.render(cameras_[0]);
  cv::Scalar mean, spread;
  cv::meanStdDev(image(cv::Rect(100, 20, 50, 40)), mean, spread);
  EXPECT_GT(mean[0], 100);
  EXPECT_GT(spread[0], 0.5);
  EXPECT_LT(spread[0], 12);
}

}  // namespace
}  // namespace cornerstone
