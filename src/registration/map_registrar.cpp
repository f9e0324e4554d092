#include "cornerstone/registration/map_registrar.h"

namespace cornerstone {

MapRegistrar::MapRegistrar(const LandmarkParams& landmarks, const RegistrationParams& registration)
    : landmark_params_(landmarks),
      params_(registration),
      reference_{LandmarkFollower(landmarks), {}},
      current_{LandmarkFollower(landmarks), {}} {}

void MapRegistrar::Side::update(const GridMap& map, double time_s, const RegistrationParams& params) {
  follower.update(map, time_s);
  if (!evidence || follower.searchedShare() > 0)
    evidence = gatherEvidence({map, follower.landmarks()}, params);
}

RegistrationAttempt MapRegistrar::attempt(const RegistrationTask& task) {
  if (task.reference_anew) reference_ = {LandmarkFollower(landmark_params_), {}};
  if (task.current_anew) current_ = {LandmarkFollower(landmark_params_), {}};
  RegistrationAttempt attempt;
  if (task.reference) {
    reference_.update(*task.reference, task.time_s, params_);
    current_.update(task.current, task.time_s, params_);
    attempt.outcome = registerMaps(reference_.prepared(), current_.prepared(), task.hints, params_);
    if (!attempt.outcome.registration && task.hints.prior) {
      RegistrationHints anywhere = task.hints;
      anywhere.prior.reset();
      RegistrationOutcome found = registerMaps(reference_.prepared(), current_.prepared(), anywhere, params_);
      if (found.registration) attempt.outcome = found;
    }
  } else {
    current_.follower.update(task.current, task.time_s);
    current_.evidence.reset();
  }
  attempt.landmarks = current_.follower.landmarks();
  if (attempt.outcome.registration)
    for (const auto& [reference, current] : attempt.outcome.registration->matches)
      attempt.pairs.emplace_back(
          reference_.follower.landmarks().corners.at(static_cast<std::size_t>(reference)),
          attempt.landmarks.corners.at(static_cast<std::size_t>(current)));
  return attempt;
}

}  // namespace cornerstone
