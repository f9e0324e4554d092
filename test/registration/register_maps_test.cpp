// Contract of the registration: the ugly cases are answered rightly or refused with a reason, never answered
// wrongly.
#include "cornerstone/registration/register_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/drawn_maps.h"

namespace cornerstone {
namespace {

using Answer = RegistrationOutcome;

Answer align(const GridMap& reference, const GridMap& current,
             const std::optional<Pose2>& prior = std::nullopt) {
  const Landmarks there = detectLandmarks(reference, {}), here = detectLandmarks(current, {});
  Answer answer = registerMaps({reference, there}, {current, here}, {prior, {}}, {});
  EXPECT_EQ(answer.registration.has_value(), answer.refusal.empty());
  return answer;
}

// reference_from_current of two views of one world.
Pose2 truth(const Pose2& world_from_reference, const Pose2& world_from_current) {
  return world_from_reference.inverse() * world_from_current;
}

void expectPose(const Answer& answer, const Pose2& expected, double distance_m, double angle_rad) {
  ASSERT_TRUE(answer.registration.has_value()) << answer.refusal;
  const Pose2 pose = answer.registration->reference_from_current;
  EXPECT_LT((pose.translation() - expected.translation()).norm(), distance_m);
  EXPECT_LT(std::abs(wrapAngle(pose.yaw_rad - expected.yaw_rad)), angle_rad);
}

// Refused for one of the given reasons.
void expectRefused(const Answer& answer, const std::vector<std::string>& reasons) {
  EXPECT_FALSE(answer.registration.has_value());
  EXPECT_TRUE(std::any_of(reasons.begin(), reasons.end(), [&](const std::string& reason) {
    return answer.refusal.find(reason) != std::string::npos;
  })) << answer.refusal;
}

const Pose2 kHere{2.3, -1.1, 2.1};
constexpr double kFine_m = 0.02;
constexpr double kFine_rad = 0.2 * M_PI / 180;

TEST(RegisterMaps, IdenticalMaps) {
  const GridMap map = draw(drawnOffice(), {Pose2{0, 0, 0.3}});
  const Answer answer = align(map, map);
  expectPose(answer, {}, 1e-3, 1e-4);
  EXPECT_GT(answer.registration->agreement, 0.99);
  EXPECT_NEAR(answer.registration->overlap, 1, 0.02);
  EXPECT_GT(answer.registration->matches.size(), 10u);
}

TEST(RegisterMaps, AnyHeading) {
  const Pose2 there{0, 0, 0.1};
  const GridMap reference = draw(drawnOffice(), {there});
  for (const double yaw : {-3.0, -1.9, -0.4, 0.8, 1.7, 2.6}) {
    const Pose2 here{1.5, -0.7, yaw};
    expectPose(align(reference, draw(drawnOffice(), {here})), truth(there, here), kFine_m, kFine_rad);
  }
}

TEST(RegisterMaps, NoiseAndHalfTheOverlap) {
  const Pose2 there{0, 0, 0.1};
  const GridMap reference = draw(drawnOffice(), {there, {-1, -2, 12, 12}, 0.15, 5});
  const GridMap current = draw(drawnOffice(), {kHere, {5, -2, 18, 12}, 0.15, 6});
  expectPose(align(reference, current), truth(there, kHere), 0.03, 2 * kFine_rad);
}

TEST(RegisterMaps, InverseIsConsistent) {
  const GridMap a = draw(drawnOffice(), {Pose2{0, 0, 0.1}}),
                b = draw(drawnOffice(), {kHere, {-1, -2, 13, 12}});
  const Answer forth = align(a, b), back = align(b, a);
  ASSERT_TRUE(forth.registration && back.registration);
  const Pose2 round = forth.registration->reference_from_current * back.registration->reference_from_current;
  EXPECT_LT(round.translation().norm(), 0.01);
  EXPECT_LT(std::abs(round.yaw_rad), 1e-3);
}

TEST(RegisterMaps, SameInputSameAnswer) {
  const GridMap a = draw(drawnOffice(), {Pose2{0, 0, 0.1}}),
                b = draw(drawnOffice(), {kHere, {-1, -2, 13, 12}, 0.1, 3});
  const Answer one = align(a, b), two = align(a, b);
  ASSERT_TRUE(one.registration && two.registration);
  EXPECT_EQ(one.registration->reference_from_current.x_m, two.registration->reference_from_current.x_m);
  EXPECT_EQ(one.registration->reference_from_current.yaw_rad,
            two.registration->reference_from_current.yaw_rad);
}

TEST(RegisterMaps, RefusesWithoutOverlap) {
  const GridMap a = draw(drawnOffice(), {Pose2{}, {-1, -2, 5.9, 12}}),
                b = draw(drawnOffice(), {kHere, {12.1, -2, 18, 12}});
  expectRefused(align(a, b), {"no pose agrees", "too little wall agrees"});
}

TEST(RegisterMaps, RefusesAMirroredMap) {
  const GridMap map = draw(drawnOffice(), {Pose2{0, 0, 0.1}});
  GridMap mirrored = map;
  mirrored.occupied = cv::Mat1f();  // a copy would share the cells
  cv::flip(map.occupied, mirrored.occupied, 1);
  EXPECT_FALSE(align(map, mirrored).registration.has_value());
}

TEST(RegisterMaps, RefusesASymmetricRoomUnlessAPriorTells) {
  DrawnWorld world;
  world.rooms = {{-3, -3, 3, 3}};
  const Pose2 there{0, 0, 0.1}, here{0.5, 0.2, 0.4};
  const GridMap a = draw(world, {there}), b = draw(world, {here});
  expectRefused(align(a, b), {"too little wall agrees", "another pose"});
  const Pose2 rough = truth(there, here) * Pose2{0.3, -0.2, 0.1};
  expectPose(align(a, b, rough), truth(there, here), 0.02, 3 * kFine_rad);
}

TEST(RegisterMaps, RefusesALongCorridor) {
  DrawnWorld world;
  world.rooms = {{0, 0, 60, 2.2}};
  const Pose2 there{0, 0, 0.1}, here{10, 0, 0.2};
  const GridMap a = draw(world, {there, {5, -1, 35, 4}}), b = draw(world, {here, {20, -1, 50, 4}});
  expectRefused(align(a, b), {"another pose", "one direction open"});
  expectRefused(align(a, b, truth(there, here) * Pose2{0.4, 0.1, 0.02}), {"one direction open"});
}

TEST(RegisterMaps, RefusesRepeatedIdenticalOffices) {
  DrawnWorld world;
  world.rooms = {{0, 0, 40, 2}};
  for (int i = 0; i < 10; ++i) {
    world.rooms.push_back({4.0 * i + 0.1, 2.2, 4.0 * i + 3.9, 6});
    world.rooms.push_back({4.0 * i + 1, 2, 4.0 * i + 1.9, 2.2});
    world.solids.push_back({4.0 * i + 0.1, 5, 4.0 * i + 1.5, 6});
  }
  const GridMap a = draw(world, {Pose2{0, 0, 0.1}, {2, -1, 26, 7}}),
                b = draw(world, {Pose2{3, 1, 1.0}, {14, -1, 38, 7}});
  EXPECT_FALSE(align(a, b).registration.has_value());
}

TEST(RegisterMaps, RefusesOnOneCornerOnly) {
  DrawnWorld world;
  world.rooms = {{0, 0, 20, 20}};
  const DrawnBox corner{-1, -1, 2.5, 2.5};
  EXPECT_FALSE(align(draw(world, {Pose2{0, 0, 0.1}, corner}), draw(world, {Pose2{1, 0, 0.9}, corner}))
                   .registration.has_value());
}

GridMap uniform(int cols, int rows, float probability) {
  GridMap map;
  map.geometry = {0.05, -1, 2, cols, rows};
  map.occupied = cv::Mat1f(rows, cols, probability);
  return map;
}

TEST(RegisterMaps, RefusesEmptyMapsEitherWay) {
  const GridMap office = draw(drawnOffice(), {Pose2{}});
  for (const GridMap& empty : {GridMap{}, uniform(1, 1, 1.0f), uniform(1, 1, 0.0f), uniform(50, 40, kUnseen),
                               uniform(50, 40, 0.0f), uniform(50, 40, 1.0f)}) {
    EXPECT_FALSE(align(office, empty).registration.has_value());
    EXPECT_FALSE(align(empty, office).registration.has_value());
    EXPECT_FALSE(align(empty, empty).registration.has_value());
    EXPECT_FALSE(align(office, empty, Pose2{}).registration.has_value());
  }
}

// What is known counts, not the size of the grid that holds it.
TEST(RegisterMaps, TenThousandByTenThousandCells) {
  const Pose2 there{0, 0, 0.1};
  const GridMap office = draw(drawnOffice(), {there});
  GridMap vast;
  vast.geometry = office.geometry;
  vast.geometry.cols = vast.geometry.rows = 10000;
  vast.geometry.origin_x_m -= 4321 * office.geometry.resolution_m;
  vast.geometry.origin_y_m -= 1234 * office.geometry.resolution_m;
  vast.occupied = cv::Mat1f(10000, 10000, kUnseen);
  office.occupied.copyTo(vast.occupied(cv::Rect(4321, 1234, office.geometry.cols, office.geometry.rows)));
  expectPose(align(vast, draw(drawnOffice(), {kHere})), truth(there, kHere), kFine_m, kFine_rad);
}

TEST(RegisterMaps, DifferentResolutions) {
  const Pose2 there{0, 0, 0.1};
  for (const double resolution_m : {0.025, 0.08, 0.1}) {
    DrawnView other{kHere};
    other.resolution_m = resolution_m;
    expectPose(align(draw(drawnOffice(), {there}), draw(drawnOffice(), other)), truth(there, kHere), 0.04,
               3 * kFine_rad);
  }
}

// A building that is its own half turn, of which the maps share a part: the wrong half turn lays more of them
// on each other, and nothing but the share speaks against it.
TEST(RegisterMaps, RefusesABuildingThatIsItsOwnHalfTurn) {
  DrawnWorld world;
  world.rooms = {{0, 0, 24, 2}};
  const double widths_m[] = {3, 5, 4, 6, 4.5, 1.5};
  double x = 0;
  for (const double width_m : widths_m) {
    world.rooms.push_back({x, 2.2, x + width_m - 0.2, 6});
    world.rooms.push_back({x + 0.4, 2, x + 1.2, 2.2});
    world.rooms.push_back({24 - x - width_m + 0.2, -4, 24 - x, -0.2});  // the same about (12, 1)
    world.rooms.push_back({24 - x - 1.2, -0.2, 24 - x - 0.4, 0});
    x += width_m;
  }
  const GridMap a = draw(world, {Pose2{0, 0, 0.1}, {-1, -5, 15, 7}}),
                b = draw(world, {Pose2{3, 1, 1.0}, {9, -5, 25, 7}});
  EXPECT_FALSE(align(a, b).registration.has_value());
}

TEST(RegisterMaps, APriorElsewhereIsNotFollowed) {
  const GridMap a = draw(drawnOffice(), {Pose2{0, 0, 0.1}}), b = draw(drawnOffice(), {kHere});
  const Pose2 wrong = truth({0, 0, 0.1}, kHere) * Pose2{4, 3, 1};
  EXPECT_FALSE(align(a, b, wrong).registration.has_value());
}

TEST(RegisterMaps, RoughPriorIsEnough) {
  const Pose2 there{0, 0, 0.1};
  const GridMap a = draw(drawnOffice(), {there, {-1, 3, 18, 12}}),
                b = draw(drawnOffice(), {kHere, {6, 3, 18, 12}});
  expectPose(align(a, b, truth(there, kHere) * Pose2{-0.4, 0.3, 0.2}), truth(there, kHere), kFine_m,
             2 * kFine_rad);
}

}  // namespace
}  // namespace cornerstone
