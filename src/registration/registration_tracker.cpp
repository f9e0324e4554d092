#include "cornerstone/registration/registration_tracker.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"
#include "cornerstone/registration/frame_smoother.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, TrackerParams& params) {
  visitor.field("agreeing_answers", params.agreeing_answers);
  visitor.field("agree_distance_m", params.agree_distance_m);
  visitor.degrees("agree_angle_deg", params.agree_angle_rad);
  visitor.field("contradicting_answers", params.contradicting_answers);
  visitor.field("follow_share", params.follow_share);
  visitor.field("age_sigma_m_per_sqrt_s", params.age_sigma_m_per_sqrt_s);
  visitor.degrees("age_sigma_deg_per_sqrt_s", params.age_sigma_rad_per_sqrt_s);
}

RegistrationTracker::RegistrationTracker(const TrackerParams& params) : params_(params) {
  requirePositive(params.agreeing_answers, "agreeing_answers");
  requirePositive(params.contradicting_answers, "contradicting_answers");
  requirePositive(params.agree_distance_m, "agree_distance_m");
  requirePositive(params.agree_angle_rad, "agree_angle_deg");
  requireWithin(params.follow_share, 0.01, 1, "follow_share");
}

bool RegistrationTracker::agrees(const Registration& answer, const Eigen::Vector2d& centre_m) const {
  const Pose2& known = estimate_->reference_from_current;
  const Pose2& found = answer.reference_from_current;
  return (known * centre_m - found * centre_m).norm() <= params_.agree_distance_m &&
         std::abs(wrapAngle(known.yaw_rad - found.yaw_rad)) <= params_.agree_angle_rad;
}

void RegistrationTracker::follow(const Registration& answer, const Eigen::Vector2d& centre_m) {
  const double share = state_ == RegistrationState::kRegistered ? params_.follow_share : 1;
  const Pose2 next =
      between(estimate_->reference_from_current, answer.reference_from_current, centre_m, share);
  estimate_ = answer;
  estimate_->reference_from_current = next;
}

bool RegistrationTracker::update(const std::optional<Registration>& answer, const Eigen::Vector2d& centre_m,
                                 double time_s) {
  if (!answer) return false;
  if (estimate_ && agrees(*answer, centre_m)) {
    follow(*answer, centre_m);
    contradicting_ = 0;
    evidence_time_s_ = time_s;
    ++agreeing_;
    if (agreeing_ >= params_.agreeing_answers) {
      state_ = RegistrationState::kRegistered;
      reason_.clear();
    }
    return true;
  }
  if (state_ == RegistrationState::kRegistered && ++contradicting_ < params_.contradicting_answers)
    return false;
  const bool lost = state_ == RegistrationState::kRegistered;
  if (lost) {
    lose("the maps now agree on another pose");
    return false;
  }
  estimate_ = answer;
  agreeing_ = 1;
  contradicting_ = 0;
  evidence_time_s_ = time_s;
  state_ = params_.agreeing_answers <= 1 ? RegistrationState::kRegistered : RegistrationState::kCandidate;
  reason_ = state_ == RegistrationState::kRegistered ? "" : "waiting for agreeing answers";
  return true;
}

void RegistrationTracker::lose(const std::string& reason) {
  state_ = state_ == RegistrationState::kRegistered ? RegistrationState::kLost : RegistrationState::kNone;
  reason_ = reason;
  estimate_.reset();
  agreeing_ = 0;
  contradicting_ = 0;
}

Eigen::Matrix3d RegistrationTracker::covarianceAt(double time_s) const {
  const double age_s = std::max(0., time_s - evidence_time_s_);
  const double var_m2 = std::pow(params_.age_sigma_m_per_sqrt_s, 2) * age_s;
  const double var_rad2 = std::pow(params_.age_sigma_rad_per_sqrt_s, 2) * age_s;
  return estimate_->covariance + Eigen::Matrix3d(Eigen::Vector3d(var_m2, var_m2, var_rad2).asDiagonal());
}

}  // namespace cornerstone
