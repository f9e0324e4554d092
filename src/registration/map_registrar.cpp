#include "cornerstone/registration/map_registrar.h"

namespace cornerstone {

MapRegistrar::MapRegistrar(const LandmarkParams& landmarks, const RegistrationParams& registration)
    : landmark_params_(landmarks), params_(registration), current_{LandmarkFollower(landmarks), {}} {}

void MapRegistrar::Side::update(const MapNews& news, const RegistrationParams& params) {
  follower.update(news.map, news.time_s);
  if (!evidence || follower.searchedShare() > 0)
    evidence = gatherEvidence({news.map, follower.landmarks()}, params);
  evidence->way_m = news.way_m;
}

RegistrationOutcome MapRegistrar::registerIn(const Side& reference, const RegistrationHints& hints) const {
  RegistrationOutcome outcome = registerMaps(reference.prepared(), current_.prepared(), hints, params_);
  if (outcome.registration || !hints.prior) return outcome;
  RegistrationHints anywhere = hints;
  anywhere.prior.reset();
  RegistrationOutcome found = registerMaps(reference.prepared(), current_.prepared(), anywhere, params_);
  return found.registration ? found : outcome;
}

RegistrationAttempt MapRegistrar::attempt(const RegistrationTask& task) {
  if (task.reference_anew) references_.erase(task.reference_robot);
  if (task.current_anew) current_ = {LandmarkFollower(landmark_params_), {}};
  RegistrationAttempt attempt;
  if (!task.reference) {
    current_.follower.update(task.current, task.time_s);
    current_.evidence.reset();
    attempt.landmarks = current_.follower.landmarks();
    return attempt;
  }
  Side& reference =
      references_.try_emplace(task.reference_robot, Side{LandmarkFollower(landmark_params_), {}})
          .first->second;
  reference.update({*task.reference, task.reference_way_m, task.time_s}, params_);
  current_.update({task.current, task.current_way_m, task.time_s}, params_);
  attempt.outcome = registerIn(reference, task.hints);
  attempt.landmarks = current_.follower.landmarks();
  if (attempt.outcome.registration)
    for (const auto& [there, here] : attempt.outcome.registration->matches)
      attempt.pairs.emplace_back(reference.follower.landmarks().corners.at(static_cast<std::size_t>(there)),
                                 attempt.landmarks.corners.at(static_cast<std::size_t>(here)));
  return attempt;
}

}  // namespace cornerstone
