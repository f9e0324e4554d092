#include "cornerstone/registration/decision.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace cornerstone {
namespace {

// Log-odds of being right.
constexpr double kConstant = -2.18;
constexpr double kPerLead = 2.73;            // per standard deviation
constexpr double kPerContradiction = -2.02;  // per e-fold of the contradicting metres
constexpr double kFewMetres_m = 0.5;         // of contradiction are noise
// A prior leaves a thousandth of the poses to coincidence; some of that is kept back for priors that are
// wrong.
constexpr double kPrior = 2.0;
// Walls come in pieces that agree or do not as a whole: so many metres are one piece of evidence.
constexpr double kPiece_m = 0.3;
constexpr double kNoise_m2 = 1.0;  // variance of a score without any wall
// Contradicting share of a rival's edges below which it stands in its own right: noise alone makes so much.
constexpr double kClear = 0.05;
constexpr double kTie = 0.95;       // of the values: not told apart once neighbourhoods may give way
constexpr double kSmallLead = 2.5;  // below it a rival is the reason rather than the contradictions

double valueOf(const PoseScore& score) { return score.agree - score.contradict; }

// Like the difference of two counts: its variance is their sum.
double leadSigmas(const PoseScore& best, const PoseScore& rival, double square_m) {
  const double lead_m = (valueOf(best) - valueOf(rival)) * square_m;
  return std::max(lead_m, 0.0) / std::sqrt(kNoise_m2 + kPiece_m * (best.agree + rival.agree) * square_m);
}

double neededAgreement_m(const PoseEvidence& evidence, const RegistrationParams& params) {
  if (evidence.with_prior) return params.min_agreeing_with_prior_m;
  const double of_small_map_m =
      std::max(params.min_agreeing_share * evidence.smaller_map_m, params.min_agreeing_small_map_m);
  return std::min(params.min_agreeing_m, of_small_map_m);
}

}  // namespace

PoseEvidence weighPoses(const std::vector<JudgedPose>& poses, double square_m) {
  PoseEvidence evidence;
  if (poses.empty() || valueOf(poses.front().elastic) <= 0) return evidence;
  const JudgedPose& best = poses.front();
  evidence.agreeing_m = best.elastic.agree * square_m;
  evidence.contradicting_m = best.elastic.contradict * square_m;
  evidence.lead_sigmas = leadSigmas(best.rigid, {}, square_m);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const PoseScore& rival = poses[i].elastic;
    const double share = valueOf(rival) / valueOf(best.elastic);
    evidence.lead_sigmas = std::min(evidence.lead_sigmas, leadSigmas(best.rigid, poses[i].rigid, square_m));
    evidence.second_best = std::max(evidence.second_best, share);
    if (rival.contradict < kClear * rival.agree) evidence.clear_rival = std::max(evidence.clear_rival, share);
  }
  return evidence;
}

double probabilityRight(const PoseEvidence& evidence) {
  if (evidence.agreeing_m - evidence.contradicting_m <= 0) return 0;
  const double log_odds = kConstant + kPerLead * evidence.lead_sigmas +
                          kPerContradiction * std::log(evidence.contradicting_m + kFewMetres_m) +
                          (evidence.with_prior ? kPrior : 0);
  return 1 / (1 + std::exp(-log_odds));
}

std::optional<std::string> reasonToRefuse(const PoseEvidence& evidence, const RegistrationParams& params) {
  if (evidence.agreeing_m < neededAgreement_m(evidence, params)) return "too little wall agrees";
  if (evidence.contradicting_m >
      params.max_contradicting_share * (evidence.agreeing_m + evidence.contradicting_m))
    return "too much of the walls contradicts";
  if (evidence.second_best > kTie) return "another pose fits as well where the maps may bend";
  if (evidence.clear_rival > params.max_clear_rival) return "a different pose is free of contradictions, too";
  if (evidence.spread < params.min_spread) return "the walls leave one direction open";
  if (probabilityRight(evidence) >= params.min_probability) return std::nullopt;
  std::ostringstream reason;
  reason << std::fixed << std::setprecision(1)
         << (evidence.lead_sigmas < kSmallLead ? "another pose fits nearly as well"
                                               : "the maps contradict each other")
         << " (" << evidence.agreeing_m << " m of wall agree, " << evidence.contradicting_m
         << " m contradict, ahead of the next pose by " << evidence.lead_sigmas << " sigmas)";
  return reason.str();
}

}  // namespace cornerstone
