#include "cornerstone/registration/map_registrar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "support/drawn_maps.h"

namespace cornerstone {
namespace {

const Pose2 kThere{0, 0, 0.1}, kHere{2.3, -1.1, 2.1};
const GridMap& reference() {
  static const GridMap map = draw(drawnOffice(), {kThere});
  return map;
}

TEST(MapRegistrar, AnswersAsASingleRegistrationDoesAndKeepsItsPairs) {
  MapRegistrar registrar({}, {});
  const GridMap current = draw(drawnOffice(), {kHere});
  const Pose2 truth = kThere.inverse() * kHere;
  for (int i = 0; i < 2; ++i) {  // the second time nothing has changed
    const RegistrationAttempt attempt = registrar.attempt({reference(), current, {}, 1.0 * i, "a"});
    ASSERT_TRUE(attempt.outcome.registration) << attempt.outcome.refusal;
    const Pose2 pose = attempt.outcome.registration->reference_from_current;
    EXPECT_LT((pose.translation() - truth.translation()).norm(), 0.02);
    EXPECT_EQ(attempt.pairs.size(), attempt.outcome.registration->matches.size());
    EXPECT_GT(attempt.pairs.size(), 10u);
    for (const auto& [there, here] : attempt.pairs) {
      EXPECT_EQ(there.kind, here.kind);
      EXPECT_LT((there.pose.translation() - pose * here.pose.translation()).norm(), 0.3);
    }
  }
}

TEST(MapRegistrar, APriorThatNoLongerHoldsGivesWayToWhatTheMapsSay) {
  MapRegistrar registrar({}, {});
  RegistrationHints hints;
  const Pose2 truth = kThere.inverse() * kHere;
  hints.prior = truth * Pose2{4, 3, 1};
  const RegistrationAttempt attempt =
      registrar.attempt({reference(), draw(drawnOffice(), {kHere}), hints, 0, "a"});
  ASSERT_TRUE(attempt.outcome.registration) << attempt.outcome.refusal;
  EXPECT_LT((attempt.outcome.registration->reference_from_current.translation() - truth.translation()).norm(),
            0.02);
}

TEST(MapRegistrar, WithoutAReferenceItOnlyFindsLandmarks) {
  MapRegistrar registrar({}, {});
  const RegistrationAttempt attempt = registrar.attempt({std::nullopt, reference(), {}, 0, ""});
  EXPECT_FALSE(attempt.outcome.registration);
  EXPECT_GT(attempt.landmarks.corners.size(), 20u);
  EXPECT_NE(attempt.landmarks.corners.front().id, 0u);
}

TEST(MapRegistrar, AMapThatBeganAnewHasNewCorners) {
  MapRegistrar registrar({}, {});
  registrar.attempt({std::nullopt, reference(), {}, 0, ""});
  const RegistrationAttempt followed = registrar.attempt({std::nullopt, reference(), {}, 5, ""});
  EXPECT_EQ(followed.landmarks.corners.front().since_s, 0);
  RegistrationTask anew;
  anew.current = reference();
  anew.time_s = 7;
  anew.current_anew = true;
  EXPECT_EQ(registrar.attempt(anew).landmarks.corners.front().since_s, 7);
}

TEST(MapRegistrar, KeepsTheRobotsApart) {
  MapRegistrar registrar({}, {});
  const GridMap current = draw(drawnOffice(), {kHere});
  const Pose2 elsewhere{5, 1, -0.7};
  const std::vector<std::pair<std::string, Pose2>> robots{{"a", kThere}, {"b", elsewhere}, {"a", kThere}};
  for (const auto& [robot, office_from_map] : robots) {
    const GridMap theirs = draw(drawnOffice(), {office_from_map});
    const RegistrationAttempt attempt = registrar.attempt({theirs, current, {}, 0, robot});
    ASSERT_TRUE(attempt.outcome.registration) << robot << ": " << attempt.outcome.refusal;
    const Pose2 truth = office_from_map.inverse() * kHere;
    const Pose2 pose = attempt.outcome.registration->reference_from_current;
    EXPECT_LT((pose.translation() - truth.translation()).norm(), 0.02) << robot;
  }
}

TEST(MapRegistrar, EmptyMapsAreRefused) {
  MapRegistrar registrar({}, {});
  EXPECT_EQ(registrar.attempt({GridMap{}, reference(), {}, 0, "a"}).outcome.refusal,
            "the reference map has no edges");
  EXPECT_EQ(registrar.attempt({reference(), GridMap{}, {}, 1, "a"}).outcome.refusal,
            "the current map has no edges");
}

}  // namespace
}  // namespace cornerstone
