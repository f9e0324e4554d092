#include "cornerstone/registration/registration_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

const Eigen::Vector2d kCentre(5, 0);  // the current map lies 5 m from its frame's origin

Registration at(double x_m, double y_m, double yaw_rad) {
  Registration registration;
  registration.reference_from_current = {x_m, y_m, yaw_rad};
  registration.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  return registration;
}

TEST(RegistrationTracker, SharesNoFrameBeforeAgreeingAnswers) {
  RegistrationTracker tracker(TrackerParams{});
  EXPECT_EQ(tracker.state(), RegistrationState::kNone);
  EXPECT_FALSE(tracker.estimate());
  tracker.update({}, kCentre, 0);
  EXPECT_EQ(tracker.state(), RegistrationState::kNone);
  tracker.update(at(1, 2, 0.5), kCentre, 1);
  EXPECT_EQ(tracker.state(), RegistrationState::kCandidate);
  tracker.update(at(1.02, 2, 0.5), kCentre, 2);
  EXPECT_EQ(tracker.state(), RegistrationState::kCandidate);
  tracker.update(at(1.01, 2, 0.5), kCentre, 3);
  EXPECT_EQ(tracker.state(), RegistrationState::kRegistered);
  EXPECT_NEAR(tracker.estimate()->reference_from_current.x_m, 1.01, 1e-12);
}

TEST(RegistrationTracker, StartsOverWhenCandidatesDisagree) {
  RegistrationTracker tracker(TrackerParams{});
  tracker.update(at(1, 2, 0), kCentre, 1);
  tracker.update(at(1, 2, 0), kCentre, 2);
  tracker.update(at(4, 2, 0), kCentre, 3);
  tracker.update(at(4, 2, 0), kCentre, 4);
  EXPECT_EQ(tracker.state(), RegistrationState::kCandidate);
  tracker.update(at(4, 2, 0), kCentre, 5);
  EXPECT_EQ(tracker.state(), RegistrationState::kRegistered);
  EXPECT_NEAR(tracker.estimate()->reference_from_current.x_m, 4, 1e-12);
}

RegistrationTracker registered() {
  RegistrationTracker tracker(TrackerParams{});
  for (int i = 0; i < 3; ++i) tracker.update(at(1, 2, 0), kCentre, i);
  return tracker;
}

TEST(RegistrationTracker, FollowsInSmallStepsAroundTheMapNotTheOrigin) {
  RegistrationTracker tracker = registered();
  // The found pose turns the current map by 0.02 rad about its own middle: the middle must stay where it is.
  const Pose2 known{1, 2, 0};
  Pose2 turned{0, 0, 0.02};
  const Eigen::Vector2d origin = known * kCentre - turned.rotation() * kCentre;
  tracker.update(at(origin.x(), origin.y(), 0.02), kCentre, 4);
  const Pose2 next = tracker.estimate()->reference_from_current;
  EXPECT_NEAR(next.yaw_rad, 0.01, 1e-12);
  EXPECT_NEAR((next * kCentre - known * kCentre).norm(), 0, 1e-12);
}

TEST(RegistrationTracker, WithdrawsTheFrameOnContradictionAndRecovers) {
  RegistrationTracker tracker = registered();
  tracker.update(at(3, 2, 0), kCentre, 4);
  EXPECT_EQ(tracker.state(), RegistrationState::kRegistered) << "one outlier does not move robots";
  EXPECT_NEAR(tracker.estimate()->reference_from_current.x_m, 1, 1e-12);
  tracker.update(at(3, 2, 0), kCentre, 5);
  EXPECT_EQ(tracker.state(), RegistrationState::kLost);
  EXPECT_FALSE(tracker.estimate());
  EXPECT_FALSE(tracker.reason().empty());
  for (int i = 0; i < 3; ++i) tracker.update(at(3, 2, 0), kCentre, 6 + i);
  EXPECT_EQ(tracker.state(), RegistrationState::kRegistered);
}

TEST(RegistrationTracker, TellsWhetherTheEstimateRestsOnAnAnswer) {
  RegistrationTracker tracker(TrackerParams{});
  EXPECT_FALSE(tracker.update({}, kCentre, 0));
  EXPECT_TRUE(tracker.update(at(1, 2, 0), kCentre, 1)) << "a candidate";
  EXPECT_TRUE(tracker.update(at(4, 2, 0), kCentre, 2)) << "another candidate in its place";
  tracker = registered();
  EXPECT_TRUE(tracker.update(at(1.01, 2, 0), kCentre, 4));
  EXPECT_FALSE(tracker.update(at(3, 2, 0), kCentre, 5)) << "held back as an outlier";
  EXPECT_FALSE(tracker.update(at(3, 2, 0), kCentre, 6)) << "the frame is withdrawn";
}

TEST(RegistrationTracker, AnAgreeingAnswerClearsEarlierContradiction) {
  RegistrationTracker tracker = registered();
  tracker.update(at(3, 2, 0), kCentre, 4);
  tracker.update(at(1, 2, 0), kCentre, 5);
  tracker.update(at(3, 2, 0), kCentre, 6);
  EXPECT_EQ(tracker.state(), RegistrationState::kRegistered);
}

TEST(RegistrationTracker, IsLostWhenTheOtherMapBeginsAnew) {
  RegistrationTracker tracker = registered();
  tracker.lose("the map began anew");
  EXPECT_EQ(tracker.state(), RegistrationState::kLost);
  EXPECT_EQ(tracker.reason(), "the map began anew");
  EXPECT_FALSE(tracker.estimate());
}

TEST(RegistrationTracker, CovarianceGrowsWithAge) {
  TrackerParams params;
  params.age_sigma_m_per_sqrt_s = 0.01;
  RegistrationTracker tracker(params);
  for (int i = 0; i < 3; ++i) tracker.update(at(1, 2, 0), kCentre, i);  // newest evidence at 2 s
  EXPECT_NEAR(tracker.covarianceAt(2)(0, 0), 1e-4, 1e-12);
  EXPECT_NEAR(tracker.covarianceAt(102)(0, 0), 1e-4 + 1e-2, 1e-12);  // 0.01^2 * 100 s
}

TEST(RegistrationTracker, RefusesParametersOutOfRange) {
  TrackerParams params;
  params.agreeing_answers = 0;
  EXPECT_THROW(RegistrationTracker{params}, InputError);
  params = {};
  params.follow_share = 1.5;
  EXPECT_THROW(RegistrationTracker{params}, InputError);
}

}  // namespace
}  // namespace cornerstone
