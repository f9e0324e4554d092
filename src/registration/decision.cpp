#include "cornerstone/registration/decision.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

// Log-odds of being right.
constexpr double kConstant = -2.5;
constexpr double kPerValue = 4.0;           // per e-fold of the value in metres
constexpr double kPerContradiction = -3.2;  // per e-fold of the contradicting metres
constexpr double kFewMetres_m = 0.5;        // of contradiction are noise
constexpr double kPerSecondBest = -10.0;
// A prior leaves a thousandth of the poses to coincidence; some of that is kept back for priors that are
// wrong.
constexpr double kPrior = 2.0;

}  // namespace

double probabilityRight(const PoseEvidence& evidence) {
  const double value_m = evidence.agreeing_m - evidence.contradicting_m;
  if (value_m <= 0) return 0;
  const double log_odds = kConstant + kPerValue * std::log(value_m) +
                          kPerContradiction * std::log(evidence.contradicting_m + kFewMetres_m) +
                          kPerSecondBest * std::min(evidence.second_best, 1.0) +
                          (evidence.with_prior ? kPrior : 0);
  return 1 / (1 + std::exp(-log_odds));
}

std::optional<std::string> reasonToRefuse(const PoseEvidence& evidence, const RegistrationParams& params) {
  if (evidence.agreeing_m < params.min_agreeing_m) return "too little wall agrees";
  if (evidence.second_best > params.max_second_best) return "another pose fits nearly as well";
  if (evidence.spread < params.min_spread) return "the walls leave one direction open";
  if (probabilityRight(evidence) < params.min_probability)
    return "the maps contradict each other or share too little";
  return std::nullopt;
}

}  // namespace cornerstone
