// Whether the evidence for the best pose singles it out. Everything is judged on both maps: what agrees, what
// contradicts, how far the best different pose stays behind, and whether every direction is held.
#pragma once

#include <optional>
#include <string>

#include "cornerstone/registration/registration_params.h"

namespace cornerstone {

struct PoseEvidence {
  double agreeing_m = 0;    // length of wall that agrees
  double agreement = 0;     // agreeing share of the edges that the other map can judge
  double second_best = 0;   // value of the best different pose over this one's
  double spread = 0;        // weakest over strongest direction of the refinement's information
  bool with_prior = false;  // poses far from a prior were not looked at
};

// In words why the pose must be refused; empty: it stands.
std::optional<std::string> reasonToRefuse(const PoseEvidence& evidence, const RegistrationParams& params);

}  // namespace cornerstone
