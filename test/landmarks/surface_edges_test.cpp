#include "cornerstone/landmarks/surface_edges.h"

#include <gtest/gtest.h>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/mapping/occupancy_grid.h"
#include "support/room_scan.h"

namespace cornerstone {
namespace {

constexpr double kWall_m = 2;

// Edges each 5 cm along the wall x = 2 m, drawn some way before it; free space towards the origin.
EdgeIndex edgesBefore(double before_m) {
  std::vector<EdgePoint> edges;
  for (int i = 0; i < 40; ++i) edges.push_back({{kWall_m - before_m, 0.05 * i}, {-1, 0}});
  return EdgeIndex(edges, 0.1);
}

std::vector<SurfacePoint> surfaceAt(double x_m, float weight = 1000) {
  std::vector<SurfacePoint> surface;
  for (int i = 0; i < 40; ++i)
    surface.push_back({static_cast<float>(x_m), 0.05f * static_cast<float>(i), weight});
  return surface;
}

TEST(SurfaceEdges, MeetOnTheSurfaceHoweverThickTheWallWasDrawn) {
  for (const double before_m : {0.0, 0.02, 0.05})
    for (const EdgePoint& edge : edgesOnSurface(edgesBefore(before_m), surfaceAt(kWall_m))) {
      EXPECT_NEAR(edge.position_m.x(), kWall_m, 1e-6) << before_m;
      EXPECT_EQ(edge.normal, Eigen::Vector2d(-1, 0));
    }
}

TEST(SurfaceEdges, StayWhereNoSurfaceIsKnown) {
  const EdgeIndex edges = edgesBefore(0.02);
  for (const auto& surface : {std::vector<SurfacePoint>{}, surfaceAt(kWall_m + 0.5)}) {
    const std::vector<EdgePoint> moved = edgesOnSurface(edges, surface);
    ASSERT_EQ(moved.size(), edges.edges().size());
    for (std::size_t i = 0; i < moved.size(); ++i)
      EXPECT_EQ(moved[i].position_m, edges.edges()[i].position_m);
  }
}

TEST(SurfaceEdges, TheOtherFaceOfAWallDoesNotCount) {
  std::vector<SurfacePoint> both = surfaceAt(kWall_m);
  const std::vector<SurfacePoint> other = surfaceAt(kWall_m + 0.1);
  both.insert(both.end(), other.begin(), other.end());
  for (const EdgePoint& edge : edgesOnSurface(edgesBefore(0.02), both))
    EXPECT_NEAR(edge.position_m.x(), kWall_m, 1e-6);
}

TEST(SurfaceEdges, WhatWasMeasuredBetterCountsMore) {
  std::vector<SurfacePoint> both = surfaceAt(kWall_m, 9000);
  const std::vector<SurfacePoint> vague = surfaceAt(kWall_m + 0.04, 1000);
  both.insert(both.end(), vague.begin(), vague.end());
  for (const EdgePoint& edge : edgesOnSurface(edgesBefore(0.02), both))
    EXPECT_NEAR(edge.position_m.x(), kWall_m + 0.004, 1e-6);
}

// The wall x = 5 m of a room, looked at from here with ranges as uncertain as stereo's at that distance.
GridMap wallSeenFrom(double x_m, int looks) {
  test::Room room;
  room.walls = {{{5, -3}, {5, 3}}};
  OccupancyGrid grid({});
  const double sigma_m = 0.005 * (5 - x_m) * (5 - x_m);
  for (int i = 0; i < looks; ++i) {
    const Pose2 at{x_m, 0.02 * i, 0};
    RangeScan scan = test::scanOf(room, at);
    for (Beam& beam : scan.beams) {
      beam.sigma_m = sigma_m;
      beam.near_m = beam.range_m - 2 * sigma_m;
      beam.far_m = beam.range_m + 2 * sigma_m;
      beam.clear_m = beam.near_m;
    }
    grid.insert(scan, at);
  }
  return grid.snapshot();
}

double meanX(const std::vector<EdgePoint>& edges) {
  double sum = 0;
  for (const EdgePoint& edge : edges) sum += edge.position_m.x();
  return sum / static_cast<double>(edges.size());
}

TEST(SurfaceEdges, OfAGridDrawnFromAfarAndFromNear) {
  std::vector<double> drawn, on_surface;
  for (const double from_m : {1.0, 4.0}) {
    GridMap map = wallSeenFrom(from_m, 20);
    on_surface.push_back(meanX(detectLandmarks(map, {}).edges));
    map.surface.clear();
    const std::vector<EdgePoint> edges = detectLandmarks(map, {}).edges;
    ASSERT_GT(edges.size(), 10u);
    drawn.push_back(meanX(edges));
  }
  EXPECT_GT(std::abs(drawn[0] - drawn[1]), 0.01) << "this is what is to be mended";
  for (const double x_m : on_surface) EXPECT_NEAR(x_m, 5, 0.003);
}

}  // namespace
}  // namespace cornerstone
