// A small building of vertical walls for tests of scans and maps: exact ranges, and disparity images with
// noise.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone::test {

struct Wall {
  Eigen::Vector2d from_m, to_m;
};

struct Room {
  std::vector<Wall> walls;
  double ceiling_m = 2.5;

  void addRectangle(double x0, double y0, double x1, double y1) {
    walls.push_back({{x0, y0}, {x1, y0}});
    walls.push_back({{x1, y0}, {x1, y1}});
    walls.push_back({{x1, y1}, {x0, y1}});
    walls.push_back({{x0, y1}, {x0, y0}});
  }
  std::optional<double> rangeFrom(const Eigen::Vector2d& origin_m, double heading_rad) const {
    const Eigen::Vector2d ray(std::cos(heading_rad), std::sin(heading_rad));
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      const Eigen::Vector2d along = wall.to_m - wall.from_m, to_wall = wall.from_m - origin_m;
      const double cross = ray.x() * along.y() - ray.y() * along.x();
      if (std::abs(cross) < 1e-12) continue;
      const double range_m = (to_wall.x() * along.y() - to_wall.y() * along.x()) / cross;
      const double share = (to_wall.x() * ray.y() - to_wall.y() * ray.x()) / cross;
      if (range_m > 1e-6 && share >= 0 && share <= 1) nearest_m = std::min(nearest_m, range_m);
    }
    if (!std::isfinite(nearest_m)) return std::nullopt;
    return nearest_m;
  }
  double distanceTo(const Eigen::Vector2d& point_m) const {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      const Eigen::Vector2d along = wall.to_m - wall.from_m;
      const double share = std::clamp((point_m - wall.from_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (wall.from_m + share * along - point_m).norm());
    }
    return nearest_m;
  }
};

// Two rooms joined by a corridor with a crossing, about 12 m x 9 m, with boxes: like a small office.
inline Room officeRoom() {
  Room room;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    room.walls.push_back({{x0, y0}, {x1, y1}});
  };
  room.addRectangle(0, 0, 12, 9);
  wall(0, 4, 2.5, 4), wall(3.5, 4, 7, 4), wall(8, 4, 12, 4);
  wall(0, 5.6, 4, 5.6), wall(5, 5.6, 9, 5.6), wall(10, 5.6, 12, 5.6);
  wall(6, 0, 6, 1.2), wall(6, 2.2, 6, 4);
  wall(6.5, 5.6, 6.5, 7), wall(6.5, 8, 6.5, 9);
  room.addRectangle(0.5, 0.4, 1.6, 1.1);
  room.addRectangle(10.6, 2.2, 11.5, 3.4);
  room.addRectangle(3.0, 8.1, 4.4, 8.8);
  room.addRectangle(8.6, 8.2, 9.4, 8.8);
  room.addRectangle(8.0, 0.3, 9.0, 0.9);
  return room;
}

inline TrinocularRig rigOf(int cols) {
  TrinocularRig rig;
  rig.image_size_px = {cols, cols * 3 / 4};
  rig.focal_px = cols / 2.0;  // 90 degrees
  rig.centre_x_px = (cols - 1) / 2.0;
  rig.centre_y_px = (cols * 3 / 4 - 1) / 2.0;
  rig.baseline_m = 0.12;
  return rig;
}

constexpr double kCameraHeight_m = 0.4;

// A level camera 0.4 m above the base's origin, looking along x.
inline Eigen::Isometry3d levelCamera() {
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.linear().col(0) = -Eigen::Vector3d::UnitY();
  base_from_camera.linear().col(1) = -Eigen::Vector3d::UnitZ();
  base_from_camera.linear().col(2) = Eigen::Vector3d::UnitX();
  base_from_camera.translation() = Eigen::Vector3d(0, 0, kCameraHeight_m);
  return base_from_camera;
}

struct DisparityNoise {
  double pixel_sigma_px = 0.2;    // of each window (the noise is smoothed over 9 x 9 px, as matching does)
  double answered_share = 0.7;    // of the windows; the rest is without texture
  double mismatch_share = 0.002;  // of the windows: a wrong disparity anywhere in the range
};

// What a matcher says of the room from this pose: walls from floor to ceiling, floor and ceiling.
inline Disparity disparityOf(const Room& room, const Pose2& map_from_base, const TrinocularRig& rig,
                             const DisparityNoise& noise, std::mt19937& random) {
  constexpr int kWindow_px = 9;
  Disparity disparity;
  disparity.rig = rig;
  disparity.disparity_px = cv::Mat1f::zeros(rig.image_size_px);
  disparity.sigma_px = cv::Mat1f::zeros(rig.image_size_px);
  disparity.rejection = cv::Mat1b::zeros(rig.image_size_px);
  // One value for each window of a lattice, the same for all pixels of it.
  const cv::Size lattice((rig.image_size_px.width + kWindow_px - 1) / kWindow_px,
                         (rig.image_size_px.height + kWindow_px - 1) / kWindow_px);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> even(0, 1);
  cv::Mat1d error(lattice), fate(lattice), wrong(lattice);
  for (auto& value : error) value = gauss(random) * noise.pixel_sigma_px;
  for (auto& value : fate) value = even(random);
  for (auto& value : wrong) value = 1 + even(random) * 30;
  for (int u = 0; u < rig.image_size_px.width; ++u) {
    const double x = (u - rig.centre_x_px) / rig.focal_px;
    const auto range_m = room.rangeFrom(map_from_base.translation(), map_from_base.yaw_rad - std::atan(x));
    const double wall_m = range_m ? *range_m / std::hypot(1, x) : 1e3;
    for (int v = 0; v < rig.image_size_px.height; ++v) {
      const double y = (v - rig.centre_y_px) / rig.focal_px;
      double depth_m = wall_m;
      if (y > 0) depth_m = std::min(depth_m, kCameraHeight_m / y);
      if (y < 0) depth_m = std::min(depth_m, (room.ceiling_m - kCameraHeight_m) / -y);
      const cv::Point window(u / kWindow_px, v / kWindow_px);
      if (fate(window) > noise.answered_share) continue;
      double value = rig.focal_px * rig.baseline_m / depth_m + error(window);
      if (fate(window) < noise.mismatch_share) value = wrong(window);
      if (value <= 0.3) continue;
      disparity.disparity_px(v, u) = static_cast<float>(value);
      disparity.sigma_px(v, u) = static_cast<float>(noise.pixel_sigma_px);
    }
  }
  return disparity;
}

}  // namespace cornerstone::test
