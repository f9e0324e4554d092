// Two robots in one room have each other in their maps.
#include "cornerstone/registration/robot_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cornerstone/registration/register_maps.h"
#include "support/drawn_maps.h"

namespace cornerstone {
namespace {

using Places = std::vector<Eigen::Vector2d>;

const Pose2 kThere{0.4, 0.2, 0.1}, kHere{2.3, 1.1, 2.1};  // world_from_map of the reference and the current
const Pose2 kTruth = kThere.inverse() * kHere;
// Where the robots stood, in the world.
const Places kReferenceRobot{{1.0, 1.2}, {1.2, 2.4}, {2.0, 3.2}};
const Places kCurrentRobot{{4.2, 1.0}, {4.4, 2.0}, {3.6, 3.0}};

// A room with a bay, in which something of a robot's size stands at some places.
DrawnWorld roomWith(const Places& robots) {
  DrawnWorld world{{{0, 0, 5, 4}, {1.5, 4, 3.2, 5}}, {{4.3, 3.2, 5, 4}}};
  for (const Eigen::Vector2d& at : robots)
    world.solids.push_back({at.x() - 0.2, at.y() - 0.2, at.x() + 0.2, at.y() + 0.2});
  return world;
}

Places inMap(const Pose2& world_from_map, Places places) {
  for (Eigen::Vector2d& at : places) at = world_from_map.inverse() * at;
  return places;
}

struct Seen {
  DrawnWorld by_reference, by_current;
  Places way_of_reference, way_of_current;  // in the world
};

RegistrationOutcome align(const Seen& seen) {
  const GridMap reference = draw(seen.by_reference, {kThere}), current = draw(seen.by_current, {kHere});
  const Landmarks there = detectLandmarks(reference, {}), here = detectLandmarks(current, {});
  return registerMaps({reference, there, inMap(kThere, seen.way_of_reference)},
                      {current, here, inMap(kHere, seen.way_of_current)}, {kTruth, {}}, {});
}

TEST(RobotBodies, RobotsThatSawEachOtherContradictNothing) {
  const Seen seen{roomWith(kCurrentRobot), roomWith(kReferenceRobot), kReferenceRobot, kCurrentRobot};
  const RegistrationOutcome answer = align(seen);
  ASSERT_TRUE(answer.registration) << answer.refusal;
  const Pose2 error = kTruth.inverse() * answer.registration->reference_from_current;
  EXPECT_LT(error.translation().norm(), 0.02);
  EXPECT_LT(std::abs(error.yaw_rad), 0.2 * M_PI / 180);
}

TEST(RobotBodies, WithoutTheirWaysTheyContradict) {
  const RegistrationOutcome answer = align({roomWith(kCurrentRobot), roomWith(kReferenceRobot), {}, {}});
  EXPECT_FALSE(answer.registration);
  EXPECT_NE(answer.refusal.find("contradicts"), std::string::npos) << answer.refusal;
}

TEST(RobotBodies, ThingsBesideTheWayContradict) {
  const Places elsewhere{{2.6, 0.8}, {2.8, 2.2}, {0.8, 3.4}};
  const Seen seen{roomWith(kCurrentRobot), roomWith(kReferenceRobot), elsewhere, elsewhere};
  EXPECT_FALSE(align(seen).registration);
}

// The strongest evidence against a pose: a wall where a robot has driven.
TEST(RobotBodies, AWallAcrossTheWayContradicts) {
  Places along;
  for (double y = 0.3; y < 3.8; y += 0.2) along.emplace_back(2.4, y);
  const auto excusedShare = [&](double length_m) {
    DrawnWorld walled = roomWith({});
    walled.solids.push_back({2.34, 1, 2.46, 1 + length_m});
    const GridMap reference = draw(roomWith({}), {kThere}), current = draw(walled, {kHere});
    const Landmarks there = detectLandmarks(reference, {}), here = detectLandmarks(current, {});
    const MapEvidence of_reference = gatherEvidence({reference, there, inMap(kThere, along)}, {});
    const MapEvidence of_current = gatherEvidence({current, here}, {});
    const EvidencePair maps{of_reference, of_current};
    const PoseScore score = scorePose(maps, kTruth, {ScoreLevel::kFine, 100000});
    return 1 - RobotBodies(maps, 0.25).excused(score, kTruth).contradict / score.contradict;
  };
  EXPECT_GT(excusedShare(0.4), 0.8);
  EXPECT_EQ(excusedShare(2.0), 0);
}

}  // namespace
}  // namespace cornerstone
