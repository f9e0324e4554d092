#include "cornerstone/landmarks/detect_corners.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/drawn_maps.h"

namespace cornerstone {
namespace {

// The corner of the kind that is nearest to a pose of the map's frame, and how far it is off.
struct Found {
  double distance_m = 1e9;
  double turn_rad = 1e9;
};
Found find(const Landmarks& landmarks, CornerKind kind, const Pose2& expected) {
  Found found;
  for (const CornerLandmark& corner : landmarks.corners) {
    const double distance_m = (corner.pose.translation() - expected.translation()).norm();
    if (corner.kind != kind || distance_m >= found.distance_m) continue;
    found = {distance_m, std::abs(wrapAngle(corner.pose.yaw_rad - expected.yaw_rad))};
  }
  return found;
}

TEST(DetectCorners, RoomAtAnyAngleToACentimetre) {
  DrawnWorld world;
  world.rooms = {{0, 0, 5, 4}};
  for (const double degrees : {0.0, 11.0, 22.5, 33.0, 45.0, 77.0, 150.0}) {
    const Pose2 world_from_map{0.013, 0.021, degrees * M_PI / 180};
    const Landmarks landmarks = detectLandmarks(draw(world, {world_from_map}), {});
    EXPECT_EQ(landmarks.corners.size(), 4u) << degrees;
    const Pose2 apexes[] = {{0, 0, 0}, {5, 0, M_PI / 2}, {5, 4, M_PI}, {0, 4, -M_PI / 2}};
    for (const Pose2& apex : apexes) {
      const Found found = find(landmarks, CornerKind::kInsideFree, world_from_map.inverse() * apex);
      // A cell's centre decides its state, so each edge is right to a fraction of a cell only.
      EXPECT_LT(found.distance_m, 0.03) << degrees;
      EXPECT_LT(found.turn_rad, 3 * M_PI / 180) << degrees;
    }
  }
}

TEST(DetectCorners, PillarIsOfTheOtherKind) {
  DrawnWorld world;
  world.rooms = {{0, 0, 8, 8}};
  world.solids = {{3, 3, 4.2, 4.4}};
  const Landmarks landmarks = detectLandmarks(draw(world, {Pose2{0, 0, 0.2}}), {});
  // The arms of a pillar's corner run along its faces; its inside is solid.
  const Found found = find(landmarks, CornerKind::kInsideSolid, Pose2{0, 0, 0.2}.inverse() * Pose2{3, 3, 0});
  EXPECT_LT(found.distance_m, 0.03);
  EXPECT_LT(found.turn_rad, 3 * M_PI / 180);
}

TEST(DetectCorners, BothFacesOfAThinWallAreToldApart) {
  DrawnWorld world;
  world.rooms = {{0, 0, 8, 8}};
  world.solids = {{2, 2, 5, 2.1}, {2, 2, 2.1, 5}};  // an L two cells thick, free on both sides
  const Landmarks landmarks = detectLandmarks(draw(world, {Pose2{}}), {});
  EXPECT_LT(find(landmarks, CornerKind::kInsideFree, {2.1, 2.1, 0}).distance_m, 0.02);
  EXPECT_LT(find(landmarks, CornerKind::kInsideSolid, {2, 2, 0}).distance_m, 0.02);
}

TEST(DetectCorners, NoneFromASpeckOrAStraightWall) {
  DrawnWorld world;
  world.rooms = {{0, 0, 20, 3}};
  world.solids = {{10, 1.5, 10.1, 1.6}};
  const Landmarks landmarks = detectLandmarks(draw(world, {Pose2{}, {4, -1, 16, 4}}), {});
  EXPECT_GT(landmarks.edges.size(), 400u);
  EXPECT_TRUE(landmarks.corners.empty());
}

// The jambs of a door in a thin wall are too short to be arms; those of a passage through a thick one are
// not.
TEST(DetectCorners, DoorJambsAreNoCornersUnlessTheWallIsThick) {
  for (const double thick_m : {0.15, 0.8}) {
    DrawnWorld world;
    world.rooms = {{0, 0, 6, 3}, {0, 3 + thick_m, 6, 6 + thick_m}, {2.5, 3, 3.5, 3 + thick_m}};
    const Landmarks landmarks = detectLandmarks(draw(world, {Pose2{0, 0, 0.2}}), {});
    // The wall's end is solid inside: its arms run along the wall and through the door.
    const Found jamb =
        find(landmarks, CornerKind::kInsideSolid, Pose2{0, 0, 0.2}.inverse() * Pose2{2.5, 3, M_PI / 2});
    if (thick_m < 0.5) {
      EXPECT_GT(jamb.distance_m, 0.3);
    } else {
      EXPECT_LT(jamb.distance_m, 0.03);
      EXPECT_LT(jamb.turn_rad, 3 * M_PI / 180);
    }
  }
}

TEST(DetectCorners, NoneFromAPhantomBlob) {
  DrawnWorld world;
  world.rooms = {{0, 0, 20, 20}};
  world.solids = {{10, 10, 10.3, 10.25}, {10.2, 9.9, 10.35, 10.3}, {9.85, 10.1, 10.1, 10.2}};
  const Landmarks landmarks = detectLandmarks(draw(world, {Pose2{0, 0, 0.1}, {5, 5, 15, 15}}), {});
  EXPECT_FALSE(landmarks.edges.empty());
  EXPECT_TRUE(landmarks.corners.empty());
}

TEST(DetectCorners, SuppressedCornersKeepTheirDistance) {
  const LandmarkParams params;
  const Landmarks landmarks = detectLandmarks(draw(drawnOffice(), {Pose2{0, 0, 0.4}}), params);
  EXPECT_GT(landmarks.corners.size(), 20u);
  for (std::size_t i = 0; i < landmarks.corners.size(); ++i)
    for (std::size_t j = i + 1; j < landmarks.corners.size(); ++j)
      if (landmarks.corners[i].kind == landmarks.corners[j].kind) {
        EXPECT_GE((landmarks.corners[i].pose.translation() - landmarks.corners[j].pose.translation()).norm(),
                  params.suppression_m);
      }
}

TEST(DetectCorners, NothingInMapsWithoutEdges) {
  for (const float probability : {kUnseen, 0.0f, 1.0f}) {
    GridMap map;
    map.geometry = {0.05, 0, 0, 30, 20};
    map.occupied = cv::Mat1f(20, 30, probability);
    const Landmarks landmarks = detectLandmarks(map, {});
    EXPECT_TRUE(landmarks.edges.empty());
    EXPECT_TRUE(landmarks.corners.empty());
  }
  EXPECT_TRUE(detectLandmarks(GridMap{}, {}).edges.empty());
}

TEST(DetectCorners, CovarianceIsSymmetricPositive) {
  const Landmarks landmarks = detectLandmarks(draw(drawnOffice(), {Pose2{0, 0, 0.3}}), {});
  ASSERT_FALSE(landmarks.corners.empty());
  for (const CornerLandmark& corner : landmarks.corners) {
    EXPECT_NEAR((corner.covariance - corner.covariance.transpose()).cwiseAbs().maxCoeff(), 0, 1e-12);
    for (int i = 0; i < 3; ++i) EXPECT_GT(corner.covariance(i, i), 0);
    EXPECT_LT(corner.covariance(0, 0), 0.05 * 0.05);
  }
}

}  // namespace
}  // namespace cornerstone
