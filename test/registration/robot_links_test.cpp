#include "cornerstone/registration/robot_links.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

const Eigen::Vector2d kCentre(0, 0);

Registration at(double x_m, double y_m) {
  Registration registration;
  registration.reference_from_current = {x_m, y_m, 0};
  registration.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  return registration;
}

// Robot c; a is the reference robot, b stands in between. Epochs: a's map 1, b's map 2.
RobotLinks linksOfC() {
  RobotLinks links("c", "a", {"b"}, {});
  links.beginAnew("a", 1);
  links.beginAnew("b", 2);
  return links;
}

void registerWith(RobotLinks& links, const std::string& robot, double x_m) {
  for (int i = 0; i < 3; ++i) links.update(robot, at(x_m, 0), kCentre, i);
}

ToldRoute told(double x_m, std::vector<std::string> via = {}) {
  ToldRoute told;
  told.route.reference_from_current = {x_m, 0, 0};
  told.route.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  told.route.via = std::move(via);
  told.reference_epoch = 1;
  told.robot_epoch = 2;
  return told;
}

TEST(RobotLinks, ALinkToTheReferenceRobotIsSharedAsItIs) {
  RobotLinks links = linksOfC();
  EXPECT_EQ(links.shared(kCentre, 0).state, RegistrationState::kNone);
  links.update("a", at(3, 0), kCentre, 0);
  const SharedFrame candidate = links.shared(kCentre, 0);
  EXPECT_EQ(candidate.state, RegistrationState::kCandidate);
  EXPECT_FALSE(candidate.reason.empty());
  registerWith(links, "a", 3);
  const SharedFrame shared = links.shared(kCentre, 3);
  ASSERT_EQ(shared.state, RegistrationState::kRegistered);
  EXPECT_NEAR(shared.route->reference_from_current.x_m, 3, 1e-12);
  EXPECT_TRUE(shared.route->via.empty());
  EXPECT_TRUE(shared.evidence);
}

TEST(RobotLinks, ARobotInBetweenLeadsToTheReferenceMap) {
  RobotLinks links = linksOfC();
  registerWith(links, "b", 4);
  EXPECT_EQ(links.shared(kCentre, 3).state, RegistrationState::kNone) << "b itself is not registered";
  links.hear("b", told(10));
  const SharedFrame shared = links.shared(kCentre, 3);
  ASSERT_EQ(shared.state, RegistrationState::kRegistered);
  EXPECT_NEAR(shared.route->reference_from_current.x_m, 14, 1e-12);
  EXPECT_EQ(shared.route->via, std::vector<std::string>{"b"});
  // It tells where to look for the direct link.
  EXPECT_NEAR(links.priorFor("a", shared)->x_m, 14, 1e-12);
}

TEST(RobotLinks, TheFrameIsLostWhenTheRobotInBetweenIs) {
  RobotLinks links = linksOfC();
  registerWith(links, "b", 4);
  links.hear("b", told(10));
  ASSERT_EQ(links.shared(kCentre, 3).state, RegistrationState::kRegistered);
  links.hear("b", std::nullopt);
  for (int i = 0; i < 2; ++i) {
    const SharedFrame lost = links.shared(kCentre, 4);
    EXPECT_EQ(lost.state, RegistrationState::kLost);
    EXPECT_FALSE(lost.route);
    EXPECT_FALSE(lost.reason.empty());
  }
}

TEST(RobotLinks, WhatIsToldOfOtherMapsDoesNotCount) {
  RobotLinks links = linksOfC();
  registerWith(links, "b", 4);
  ToldRoute of_an_older_map = told(10);
  of_an_older_map.robot_epoch = 1;
  links.hear("b", of_an_older_map);
  EXPECT_EQ(links.shared(kCentre, 3).state, RegistrationState::kNone);
  ToldRoute in_an_older_map = told(10);
  in_an_older_map.reference_epoch = 7;
  links.hear("b", in_an_older_map);
  EXPECT_EQ(links.shared(kCentre, 3).state, RegistrationState::kNone);
  links.hear("b", told(10));
  ASSERT_EQ(links.shared(kCentre, 3).state, RegistrationState::kRegistered);
  links.beginAnew("b", 3);
  EXPECT_EQ(links.shared(kCentre, 3).state, RegistrationState::kLost);
}

TEST(RobotLinks, TwoRobotsDoNotHoldEachOtherUp) {
  RobotLinks links = linksOfC();
  registerWith(links, "b", 4);
  links.hear("b", told(10, {"c"}));
  EXPECT_EQ(links.shared(kCentre, 3).state, RegistrationState::kNone);
  EXPECT_FALSE(links.routeOf("b"));
}

TEST(RobotLinks, ContradictingRoutesWithdrawTheFrame) {
  RobotLinks links = linksOfC();
  registerWith(links, "a", 14);
  registerWith(links, "b", 4);
  links.hear("b", told(10.1));
  const SharedFrame direct = links.shared(kCentre, 3);
  ASSERT_EQ(direct.state, RegistrationState::kRegistered);
  EXPECT_NEAR(direct.route->reference_from_current.x_m, 14, 1e-12) << "the direct one, not a mean";
  links.hear("b", told(12));
  const SharedFrame shared = links.shared(kCentre, 3);
  EXPECT_EQ(shared.state, RegistrationState::kLost);
  EXPECT_FALSE(shared.route);
  EXPECT_NE(shared.reason.find("contradict"), std::string::npos);
}

TEST(RobotLinks, ItsOwnMapBegunAnewLosesEveryLink) {
  RobotLinks links = linksOfC();
  registerWith(links, "a", 14);
  registerWith(links, "b", 4);
  ASSERT_EQ(links.shared(kCentre, 3).state, RegistrationState::kRegistered);
  links.beginAnew("c: the map began anew");
  const SharedFrame lost = links.shared(kCentre, 3);
  EXPECT_EQ(lost.state, RegistrationState::kLost);
  EXPECT_EQ(lost.reason, "c: the map began anew");
}

TEST(RobotLinks, TheReferenceRobotHearsOfTheOthersOnly) {
  RobotLinks links("a", "a", {"b"}, {});
  links.beginAnew("b", 2);
  links.hear("b", told(10));
  EXPECT_EQ(links.shared(kCentre, 0).state, RegistrationState::kNone);
  ASSERT_TRUE(links.routeOf("b"));
  EXPECT_NEAR(links.routeOf("b")->reference_from_current.x_m, 10, 1e-12);
}

}  // namespace
}  // namespace cornerstone
