// Registration over time: a frame is shared only after agreeing evidence, kept while it holds, and withdrawn
// when the evidence contradicts it. It never guesses: without REGISTERED there is no pose.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "cornerstone/base/params.h"
#include "cornerstone/registration/register_maps.h"

namespace cornerstone {

struct TrackerParams {
  // Agreeing answers in a row, on maps that changed in between, before the frame is shared.
  int agreeing_answers = 3;
  // Two answers agree within this distance, measured where the current map lies (not at its frame's origin),
  // and angle. Maps drift by some centimetres between answers; a different pose is metres or tens of degrees
  // away.
  double agree_distance_m = 0.30;
  double agree_angle_rad = 0.07;
  // Contradicting answers in a row before the shared frame is withdrawn.
  int contradicting_answers = 2;
  // Share of the way from the present estimate to a new agreeing answer: damps jumps of the tf.
  double follow_share = 0.5;
  // Standard deviation that age adds to an estimate without new evidence.
  double age_sigma_m_per_sqrt_s = 0.002;
  double age_sigma_rad_per_sqrt_s = 0.0005;
};
void describe(ParamVisitor& visitor, TrackerParams& params);

enum class RegistrationState { kNone, kCandidate, kRegistered, kLost };

class RegistrationTracker {
 public:
  explicit RegistrationTracker(const TrackerParams& params);

  // The outcome of one attempt to register, at `time_s` on any rising clock. centre_m: middle of the known
  // part of the current map, in its own frame, where agreement is measured. No answer is not a contradiction.
  // True: the estimate now rests on this answer; what else the answer brings holds with it.
  bool update(const std::optional<Registration>& answer, const Eigen::Vector2d& centre_m, double time_s);
  // The other map began anew: nothing known holds any longer.
  void lose(const std::string& reason);

  RegistrationState state() const { return state_; }
  const std::string& reason() const { return reason_; }
  // The estimate: present while CANDIDATE or REGISTERED.
  const std::optional<Registration>& estimate() const { return estimate_; }
  // Covariance of the estimate, grown by the age of its evidence. Needs an estimate.
  Eigen::Matrix3d covarianceAt(double time_s) const;
  double evidenceTime() const { return evidence_time_s_; }

 private:
  bool agrees(const Registration& answer, const Eigen::Vector2d& centre_m) const;
  void follow(const Registration& answer, const Eigen::Vector2d& centre_m);

  TrackerParams params_;
  RegistrationState state_ = RegistrationState::kNone;
  std::string reason_ = "no answer yet";
  std::optional<Registration> estimate_;
  int agreeing_ = 0;
  int contradicting_ = 0;
  double evidence_time_s_ = 0;
};

}  // namespace cornerstone
