#include "cornerstone/registration/frame_route.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

FrameRoute route(const Pose2& pose, double sigma_m, double sigma_rad, double time_s = 0) {
  FrameRoute route;
  route.reference_from_current = pose;
  route.covariance =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
  route.evidence_time_s = time_s;
  return route;
}

TEST(FrameRoute, ComposesPosesCovariancesAndNames) {
  // b stands 10 m ahead of a, turned left; c 5 m ahead of b, so 5 m to a's left.
  const FrameRoute a_from_b = route({10, 0, M_PI / 2}, 0.1, 0.02, 7), b_from_c = route({5, 0, 0}, 0.2, 0, 9);
  const FrameRoute a_from_c = throughRobot(a_from_b, "b", b_from_c);
  EXPECT_NEAR(a_from_c.reference_from_current.x_m, 10, 1e-12);
  EXPECT_NEAR(a_from_c.reference_from_current.y_m, 5, 1e-12);
  EXPECT_NEAR(a_from_c.reference_from_current.yaw_rad, M_PI / 2, 1e-12);
  // Across the lever of 5 m, 0.02 rad are 0.1 m.
  EXPECT_NEAR(a_from_c.covariance(0, 0), 0.01 + 0.04 + 0.01, 1e-12);
  EXPECT_NEAR(a_from_c.covariance(1, 1), 0.01 + 0.04, 1e-12);
  EXPECT_NEAR(a_from_c.covariance(2, 2), 0.0004, 1e-12);
  EXPECT_EQ(a_from_c.via, std::vector<std::string>{"b"});
  EXPECT_EQ(a_from_c.evidence_time_s, 7) << "as old as its oldest link";
  const FrameRoute a_from_d = throughRobot(a_from_c, "c", route({}, 0, 0));
  EXPECT_EQ(a_from_d.via, (std::vector<std::string>{"b", "c"}));
}

const RouteAgreement kLimits{{0, 0}, 0.3, 0.07};

TEST(FrameRoute, AgreementIsMeasuredWhereTheMapLies) {
  const FrameRoute one = route({0, 0, 0}, 0.001, 0), turned = route({0, 0, 0.06}, 0.001, 0);
  EXPECT_TRUE(agree(one, turned, kLimits));
  EXPECT_FALSE(agree(one, turned, {{10, 0}, 0.3, 0.07})) << "0.06 rad are 0.6 m at 10 m";
  EXPECT_TRUE(agree(one, route({0, 0, 0.06}, 0.001, 0.1), {{10, 0}, 0.3, 0.07})) << "sigma 1 m there";
  EXPECT_FALSE(agree(one, route({0.31, 0, 0}, 0.001, 0), kLimits));
  EXPECT_FALSE(agree(one, route({0, 0, 0.08}, 0.001, 0), kLimits));
}

TEST(FrameRoute, TheDirectRouteIsChosenThenTheSurest) {
  FrameRoute direct = route({1, 0, 0}, 0.1, 0), through_b = route({1.1, 0, 0}, 0.02, 0),
             through_c = route({1.05, 0, 0}, 0.01, 0);
  through_b.via = {"b"};
  through_c.via = {"c"};
  EXPECT_EQ(chooseRoute({through_b, direct, through_c}, kLimits).route->reference_from_current.x_m, 1);
  EXPECT_EQ(chooseRoute({through_b, through_c}, kLimits).route->reference_from_current.x_m, 1.05);
  const RouteChoice none = chooseRoute({}, kLimits);
  EXPECT_FALSE(none.route);
  EXPECT_TRUE(none.refusal.empty());
}

TEST(FrameRoute, NoneWhereTwoRoutesContradict) {
  FrameRoute through_b = route({4, 0, 0}, 0.01, 0);
  through_b.via = {"b"};
  const RouteChoice choice = chooseRoute({route({1, 0, 0}, 0.01, 0), through_b}, kLimits);
  EXPECT_FALSE(choice.route);
  EXPECT_NE(choice.refusal.find("the direct one and that through b"), std::string::npos) << choice.refusal;
}

}  // namespace
}  // namespace cornerstone
