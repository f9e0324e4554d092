// Maps drawn by hand for tests: rectangles of free space and walls, in metres, in any pose.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

struct DrawnBox {
  double low_x_m, low_y_m, high_x_m, high_y_m;
  bool contains(const Eigen::Vector2d& p) const {
    return p.x() >= low_x_m && p.x() < high_x_m && p.y() >= low_y_m && p.y() < high_y_m;
  }
};

// A world of free rooms in solid rock, with solid boxes in them; only rock within wall_m of free space is
// seen.
struct DrawnWorld {
  std::vector<DrawnBox> rooms;
  std::vector<DrawnBox> solids;
  double wall_m = 0.12;

  bool isFree(const Eigen::Vector2d& p) const {
    for (const DrawnBox& solid : solids)
      if (solid.contains(p)) return false;
    for (const DrawnBox& room : rooms)
      if (room.contains(p)) return true;
    return false;
  }
  float probabilityAt(const Eigen::Vector2d& p) const {
    if (isFree(p)) return 0.0f;
    for (int k = 0; k < 16; ++k) {
      const double angle = k * M_PI / 8;
      for (const double share : {0.5, 1.0})
        if (isFree(p + share * wall_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)))) return 1.0f;
    }
    return kUnseen;
  }
};

struct DrawnView {
  Pose2 world_from_map;
  DrawnBox seen{-1e3, -1e3, 1e3, 1e3};  // of the world
  double noise =
      0;  // share of the wall cells that are missing, and of free cells beside walls that are not free
  unsigned seed = 1;
  double resolution_m = 0.05;
};

inline GridMap draw(const DrawnWorld& world, const DrawnView& view) {
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const DrawnBox& room : world.rooms) {
    const double x0 = std::max(room.low_x_m, view.seen.low_x_m),
                 x1 = std::min(room.high_x_m, view.seen.high_x_m);
    const double y0 = std::max(room.low_y_m, view.seen.low_y_m),
                 y1 = std::min(room.high_y_m, view.seen.high_y_m);
    if (x0 >= x1 || y0 >= y1) continue;
    for (const double x : {x0, x1}) {
      for (const double y : {y0, y1}) {
        const Eigen::Vector2d p = view.world_from_map.inverse() * Eigen::Vector2d(x, y);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
  }
  GridMap map;
  map.geometry = {view.resolution_m, low.x() - 0.5, low.y() - 0.5,
                  static_cast<int>((high.x() - low.x() + 1) / view.resolution_m),
                  static_cast<int>((high.y() - low.y() + 1) / view.resolution_m)};
  map.occupied = cv::Mat1f(map.geometry.rows, map.geometry.cols, kUnseen);
  std::mt19937 random(view.seed);
  std::uniform_real_distribution<double> chance(0, 1);
  for (int row = 0; row < map.geometry.rows; ++row) {
    for (int col = 0; col < map.geometry.cols; ++col) {
      const Eigen::Vector2d p = view.world_from_map * map.geometry.centreOf({col, row});
      if (!view.seen.contains(p)) continue;
      float probability = world.probabilityAt(p);
      if (chance(random) < view.noise && probability != kUnseen) {
        const bool beside_wall =
            probability == 0 && world.probabilityAt(p + Eigen::Vector2d(0.06, 0)) +
                                        world.probabilityAt(p - Eigen::Vector2d(0.06, 0)) +
                                        world.probabilityAt(p + Eigen::Vector2d(0, 0.06)) +
                                        world.probabilityAt(p - Eigen::Vector2d(0, 0.06)) >
                                    0;
        probability = probability > 0.5f ? kUnseen : beside_wall ? 1.0f : 0.0f;
      }
      map.occupied(row, col) = probability;
    }
  }
  return map;
}

// Rooms off a corridor, none like another: about 17 m x 10 m.
inline DrawnWorld drawnOffice() {
  DrawnWorld world;
  world.rooms = {{0, 4, 17, 5.8},                                             // corridor
                 {0, 6, 4, 10},                                               // rooms above it
                 {4.2, 6, 9.5, 9},  {9.7, 6, 17, 10.5},  {0, 0, 6, 3.8},      // and below
                 {6.2, 1, 12, 3.8}, {12.2, -1, 17, 3.8}, {1.5, 5.8, 2.4, 6},  // doors
                 {7, 5.8, 7.9, 6},  {12, 5.8, 12.9, 6},  {4, 3.8, 4.9, 4},
                 {9, 3.8, 9.9, 4},  {15, 3.8, 15.9, 4}};
  world.solids = {{3, 8, 4, 9},     {5, 8.2, 6.5, 9}, {14, 8, 14.6, 8.6},
                  {0, 0, 1.2, 0.6}, {8, 1, 9, 1.7},   {13, 0, 14.5, 0.7}};
  return world;
}

}  // namespace cornerstone
