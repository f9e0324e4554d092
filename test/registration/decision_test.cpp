// The decision on one pose among rivals, with scores in squares of 0.1 m.
#include "cornerstone/registration/decision.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

constexpr double kSquare_m = 0.1;

// A pose that is judged alike as a rigid and as an elastic one, from metres.
JudgedPose posed(double agree_m, double contradict_m) {
  const PoseScore score{agree_m / kSquare_m, contradict_m / kSquare_m};
  return {score, score};
}

PoseEvidence evidenceFor(const std::vector<JudgedPose>& poses) {
  PoseEvidence evidence = weighPoses(poses, kSquare_m);
  evidence.spread = 1;
  return evidence;
}

bool isBelieved(const std::vector<JudgedPose>& poses) { return !reasonToRefuse(evidenceFor(poses), {}); }

TEST(Decision, TheLeadIsCountedInItsStandardDeviations) {
  // 40 - 4 m against 20 - 9 m: 25 m ahead, of a variance of 1 + 0.3 (40 + 20) = 19 m2.
  const PoseEvidence evidence = evidenceFor({posed(40, 4), posed(20, 9)});
  EXPECT_NEAR(evidence.agreeing_m, 40, 1e-9);
  EXPECT_NEAR(evidence.contradicting_m, 4, 1e-9);
  EXPECT_NEAR(evidence.lead_sigmas, 25 / std::sqrt(19.0), 1e-9);
  EXPECT_NEAR(evidence.second_best, 11.0 / 36, 1e-9);
  EXPECT_EQ(evidence.clear_rival, 0);
}

TEST(Decision, AloneAPoseMustStillLeadNothing) {
  EXPECT_NEAR(evidenceFor({posed(10, 9)}).lead_sigmas, 1 / 2.0, 1e-9);
  EXPECT_FALSE(isBelieved({posed(25, 20)}));
  EXPECT_TRUE(isBelieved({posed(25, 0.5)}));
}

TEST(Decision, ARivalNearlyAsGoodIsRefused) {
  EXPECT_TRUE(isBelieved({posed(40, 1), posed(20, 9)}));
  EXPECT_FALSE(isBelieved({posed(40, 1), posed(37, 2)}));
}

TEST(Decision, ManyContradictionsAreRefusedHoweverLargeTheLead) {
  EXPECT_TRUE(isBelieved({posed(200, 20)}));
  EXPECT_FALSE(isBelieved({posed(200, 40)}));
}

TEST(Decision, ARivalFreeOfContradictionsIsRefused) {
  EXPECT_TRUE(isBelieved({posed(45, 1), posed(17, 0)}));
  EXPECT_FALSE(isBelieved({posed(45, 1), posed(19, 0)}));
}

// Two wings of a building: the wrong one shares more of the maps, and both are contradicted somewhat.
TEST(Decision, ARivalContradictedAsLittleIsRefused) {
  EXPECT_TRUE(isBelieved({posed(150, 13), posed(60, 12)}));
  EXPECT_FALSE(isBelieved({posed(150, 13), posed(60, 5)}));
  EXPECT_TRUE(isBelieved({posed(150, 13), posed(19, 1)}));
}

// A building that is its own half turn, seen from its two ends: all of both maps agrees at the wrong pose,
// what they share of the middle at the right one.
TEST(Decision, ARivalThatWouldBeBelievedAloneIsRefused) {
  PoseEvidence evidence = evidenceFor({posed(300, 3), posed(31, 1)});
  evidence.smaller_map_m = 320;
  EXPECT_TRUE(reasonToRefuse(evidence, {}));
  evidence = evidenceFor({posed(300, 3), posed(28, 1)});
  evidence.smaller_map_m = 320;
  EXPECT_FALSE(reasonToRefuse(evidence, {}));
  evidence = evidenceFor({posed(300, 3), posed(31, 4)});  // contradicted: it would not
  evidence.smaller_map_m = 320;
  EXPECT_FALSE(reasonToRefuse(evidence, {}));
}

TEST(Decision, TooLittleWallAnOpenDirectionOrNothingIsRefused) {
  EXPECT_FALSE(isBelieved({posed(18, 0)}));
  PoseEvidence small = evidenceFor({posed(25, 0)});
  small.smaller_map_m = 35;  // 65 % are 22.75 m
  EXPECT_FALSE(reasonToRefuse(small, {}));
  small.smaller_map_m = 40;  // and here 26 m
  EXPECT_TRUE(reasonToRefuse(small, {}));
  PoseEvidence open = evidenceFor({posed(60, 1)});
  EXPECT_FALSE(reasonToRefuse(open, {}));
  open.spread = 0.01;
  EXPECT_TRUE(reasonToRefuse(open, {}));
  EXPECT_FALSE(isBelieved({}));
  EXPECT_FALSE(isBelieved({posed(5, 30)}));
}

}  // namespace
}  // namespace cornerstone
