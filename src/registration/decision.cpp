#include "cornerstone/registration/decision.h"

namespace cornerstone {

std::optional<std::string> reasonToRefuse(const PoseEvidence& evidence, const RegistrationParams& params) {
  if (evidence.agreeing_m < params.min_agreeing_m) return "too little wall agrees";
  if (evidence.agreement < params.min_agreement) return "the maps contradict each other";
  if (evidence.second_best > params.max_second_best) return "another pose fits nearly as well";
  if (evidence.spread < params.min_spread) return "the walls leave one direction open";
  return std::nullopt;
}

}  // namespace cornerstone
