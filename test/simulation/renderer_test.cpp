#include "cornerstone/simulation/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "cornerstone/simulation/camera_rig.h"

namespace cornerstone {
namespace {

const char* kHall = R"(
name: hall
seed: 3
extent_m: [-9, -9, 9, 9]
ceiling_m: 3
walls:
  - {points_m: [[4, -8], [4, 8]], height_m: 3, thickness_m: 0.2, material: paint}
robots: []
)";

// A board of 0.2 m x 0.3 m without thickness, 2 m before the origin, its centre at y = 0.3, z = 0.8.
MovingBody board() { return {boxSolid({{0, 0}, 0, {1e-4, 0.2, 0.3}, 0.65, Material::kMetal})}; }

struct Edges {
  double left, right, top, bottom;
};

// A pixel that an edge crosses shows the board by the share of its area that is covered: the sum of these
// shares, up to a pixel `inside`, tells where the edge lies to a fraction of a pixel. Pixels count from their
// centres.
double edgeBefore(const cv::Mat1f& with, const cv::Mat1f& without, int inside, int direction) {
  double shares = 0;
  for (int i = inside + 3 * direction; i != inside; i -= direction)
    shares += (with(i) - without(i)) / (with(inside) - without(i));
  return inside + direction * (0.5 + shares);
}

Edges edgesOf(const cv::Mat1f& with, const cv::Mat1f& without) {
  cv::Mat1f change;
  cv::absdiff(with, without, change);
  cv::Mat1b changed;
  cv::compare(change, 20, changed, cv::CMP_GT);
  const cv::Rect box = cv::boundingRect(changed);
  const cv::Range rows(box.y + 3, box.br().y - 3), cols(box.x + 3, box.br().x - 3);
  cv::Mat1f x_with, x_without, y_with, y_without;
  cv::reduce(with.rowRange(rows), x_with, 0, cv::REDUCE_AVG);
  cv::reduce(without.rowRange(rows), x_without, 0, cv::REDUCE_AVG);
  cv::reduce(with.colRange(cols), y_with, 1, cv::REDUCE_AVG);
  cv::reduce(without.colRange(cols), y_without, 1, cv::REDUCE_AVG);
  return {edgeBefore(x_with, x_without, box.x + 1, -1), edgeBefore(x_with, x_without, box.br().x - 2, 1),
          edgeBefore(y_with, y_without, box.y + 1, -1), edgeBefore(y_with, y_without, box.br().y - 2, 1)};
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
  RendererTest() { renderer_.place(0, {2, 0.3, 0}); }
  Edges boardSeenFrom(const Eigen::Isometry3d& world_from_camera) {
    renderer_.show(0, true);
    const cv::Mat1f with = renderer_.render(world_from_camera);
    renderer_.show(0, false);
    return edgesOf(with, renderer_.render(world_from_camera));
  }
  World world_ = parseWorld(kHall, "hall", ".");
  Renderer renderer_{world_, {board()}, setup()};
  std::array<Eigen::Isometry3d, kCameraCount> cameras_ = baseFromCameras(RigParams{});
  std::array<CameraCalibration, kCameraCount> calibrations_ = calibrationsOf(RigParams{});
};

// The mean over some places of the camera: a single edge falls on whole samples (1/8 px), and on a grain of
// its own.
TEST_F(RendererTest, KnownPointsLieWhereThePinholeProjectsThem) {
  constexpr int kPlaces = 8;
  for (std::size_t camera = 0; camera < kCameraCount; ++camera) {
    Eigen::Array4d error_px = Eigen::Array4d::Zero();
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Isometry3d pose = Eigen::Translation3d(0, 0.0037 * i, 0.0023 * i) * cameras_[camera];
      const Edges edges = boardSeenFrom(pose);
      const Eigen::Vector2d top_left = project({2, 0.4, 0.95}, pose, calibrations_[camera]);
      const Eigen::Vector2d bottom_right = project({2, 0.2, 0.65}, pose, calibrations_[camera]);
      error_px += Eigen::Array4d(edges.left - top_left.x(), edges.top - top_left.y(),
                                 edges.right - bottom_right.x(), edges.bottom - bottom_right.y());
    }
    EXPECT_LT((error_px / kPlaces).abs().maxCoeff(), 0.1) << kCameraNames[camera];
  }
}

// f = 80 px, B = 0.12 m, Z = 2 m: d = 4.8 px. Right sees a reference pixel (x, y) at (x - d, y), top at (x, y
// + d).
TEST_F(RendererTest, DisparityIsFocalLengthTimesBaselineOverRange) {
  const Edges reference = boardSeenFrom(cameras_[0]);
  const Edges right = boardSeenFrom(cameras_[1]);
  const Edges top = boardSeenFrom(cameras_[2]);
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

// A wall across the view: rows differ, along a row nothing does.
TEST(StripedWall, DiffersFromRowToRowOnly) {
  std::string hall = kHall;
  hall.replace(hall.find("paint"), 5, "stripes");
  const RigParams rig;
  const World world = parseWorld(hall, "hall", ".");
  Renderer renderer(
      world, {},
      {{rig.width_px, rig.height_px}, focalLength(rig), (rig.width_px - 1) / 2.0, (rig.height_px - 1) / 2.0});
  const cv::Mat1f wall = renderer.render(baseFromCameras(rig)[0])(cv::Rect(40, 20, 80, 40));
  for (int row = 0; row < wall.rows; ++row) {
    double low = 0, high = 0;
    cv::minMaxLoc(wall.row(row), &low, &high);
    EXPECT_LT(high - low, 1) << row;
  }
  cv::Scalar mean, spread;
  cv::meanStdDev(wall.col(40), mean, spread);
  EXPECT_GT(spread[0], 15);
}

}  // namespace
}  // namespace cornerstone
