#include "cornerstone/registration/decision.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace cornerstone {
namespace {

// Log-odds of being right.
constexpr double kConstant = 0.5;
constexpr double kPerValue = 4.0;           // per e-fold of the value in metres
constexpr double kPerContradiction = -3.7;  // per e-fold of the contradicting metres
constexpr double kFewMetres_m = 0.5;        // of contradiction are noise
constexpr double kPerSecondBest = -13.9;
// A prior leaves a thousandth of the poses to coincidence; some of that is kept back for priors that are
// wrong.
constexpr double kPrior = 2.0;
// Contradicting share of a rival's edges below which it stands in its own right: noise alone makes so much.
constexpr double kClear = 0.05;

double valueOf(const PoseScore& score) { return score.agree - score.contradict; }

}  // namespace

PoseEvidence weighScores(const std::vector<PoseScore>& scores, double square_m) {
  PoseEvidence evidence;
  if (scores.empty() || valueOf(scores.front()) <= 0) return evidence;
  evidence.agreeing_m = scores.front().agree * square_m;
  evidence.contradicting_m = scores.front().contradict * square_m;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    const double share = valueOf(scores[i]) / valueOf(scores.front());
    evidence.second_best = std::max(evidence.second_best, share);
    if (scores[i].contradict < kClear * scores[i].agree)
      evidence.clear_rival = std::max(evidence.clear_rival, share);
  }
  return evidence;
}

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
  if (evidence.agreeing_m < (evidence.with_prior ? params.min_agreeing_with_prior_m : params.min_agreeing_m))
    return "too little wall agrees";
  if (evidence.clear_rival > params.max_clear_rival) return "a different pose is free of contradictions, too";
  if (evidence.spread < params.min_spread) return "the walls leave one direction open";
  if (probabilityRight(evidence) >= params.min_probability) return std::nullopt;
  std::ostringstream reason;
  reason << std::fixed << std::setprecision(1)
         << (evidence.second_best > 0.8 ? "another pose fits nearly as well"
                                        : "the maps contradict each other")
         << " (" << evidence.agreeing_m << " m of wall agree, " << evidence.contradicting_m
         << " m contradict, the second best pose has " << std::setprecision(2) << evidence.second_best
         << " of the value)";
  return reason.str();
}

}  // namespace cornerstone
