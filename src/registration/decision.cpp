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
// What contradicts a rival, to what agrees with it, below which it stands in its own right: noise alone makes
// so much. So does a rival that is contradicted hardly more than the best pose is: what excuses the one
// excuses the other.
constexpr double kClear = 0.05;
constexpr double kHardlyMore = 1.3;
constexpr double kTie = 0.95;       // of the values: not told apart once neighbourhoods may give way
constexpr double kSmallLead = 2.5;  // below it a rival is the reason rather than the contradictions

double valueOf(const PoseScore& score) { return score.agree - score.contradict; }

bool standsAlone(const PoseScore& rival, const PoseScore& best) {
  return rival.contradict < rival.agree * std::max(kClear, kHardlyMore * best.contradict / best.agree);
}

// Like the difference of two counts: its variance is their sum.
double leadSigmas(const PoseScore& best, const PoseScore& rival, double square_m) {
  const double lead_m = (valueOf(best) - valueOf(rival)) * square_m;
  return std::max(lead_m, 0.0) / std::sqrt(kNoise_m2 + kPiece_m * (best.agree + rival.agree) * square_m);
}

std::string text(double number, int decimals) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(decimals) << number;
  return out.str();
}

double neededAgreement_m(const PoseEvidence& evidence, const RegistrationParams& params) {
  if (evidence.with_prior) return params.min_agreeing_with_prior_m;
  const double of_small_map_m =
      std::max(params.min_agreeing_share * evidence.smaller_map_m, params.min_agreeing_small_map_m);
  return std::min(params.min_agreeing_m, of_small_map_m);
}

}  // namespace

double leadOf(const std::vector<PoseScore>& poses, double square_m) {
  if (poses.empty()) return 0;
  double lead = leadSigmas(poses.front(), {}, square_m);
  for (std::size_t i = 1; i < poses.size(); ++i)
    lead = std::min(lead, leadSigmas(poses.front(), poses[i], square_m));
  return lead;
}

PoseEvidence weighPoses(const std::vector<JudgedPose>& poses, double square_m) {
  PoseEvidence evidence;
  if (poses.empty() || valueOf(poses.front().elastic) <= 0) return evidence;
  const JudgedPose& best = poses.front();
  evidence.agreeing_m = best.elastic.agree * square_m;
  evidence.contradicting_m = best.elastic.contradict * square_m;
  std::vector<PoseScore> rigid;
  for (const JudgedPose& pose : poses) rigid.push_back(pose.rigid);
  evidence.lead_sigmas = leadOf(rigid, square_m);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const PoseScore& rival = poses[i].elastic;
    const double share = valueOf(rival) / valueOf(best.elastic);
    evidence.second_best = std::max(evidence.second_best, share);
    if (!standsAlone(rival, best.elastic)) continue;
    evidence.clear_rival = std::max(evidence.clear_rival, share);
    evidence.clear_rival_m = std::max(evidence.clear_rival_m, rival.agree * square_m);
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
  const double judged_m = evidence.agreeing_m + evidence.contradicting_m;
  const double needed_m = neededAgreement_m(evidence, params);
  if (evidence.agreeing_m < needed_m)
    return "too little wall agrees: " + text(evidence.agreeing_m, 1) + " m of " + text(needed_m, 1) +
           " m needed";
  if (evidence.contradicting_m > params.max_contradicting_share * judged_m)
    return "too much wall contradicts: " + text(evidence.contradicting_m, 1) + " m of the " +
           text(judged_m, 1) + " m that both maps can judge";
  if (evidence.second_best > kTie)
    return "another pose fits as well where the maps may bend: " + text(evidence.second_best, 2) +
           " of the best one's value";
  if (evidence.clear_rival > params.max_clear_rival)
    return "a different pose is contradicted as little: " + text(evidence.clear_rival, 2) +
           " of the best one's value";
  if (evidence.clear_rival_m >= needed_m)
    return "a different pose would be believed if it were alone: " + text(evidence.clear_rival_m, 1) +
           " m of wall agree, contradicted as little";
  if (evidence.spread < params.min_spread)
    return "the walls leave one direction open: it holds " + text(evidence.spread, 3) + " of the other one";
  if (probabilityRight(evidence) >= params.min_probability) return std::nullopt;
  return (evidence.lead_sigmas < kSmallLead ? "another pose fits nearly as well: ahead of it by "
                                            : "the lead does not outweigh the contradictions: ahead by ") +
         text(evidence.lead_sigmas, 1) + " sigmas, " + text(evidence.agreeing_m, 1) + " m of wall agree, " +
         text(evidence.contradicting_m, 1) + " m contradict";
}

}  // namespace cornerstone
