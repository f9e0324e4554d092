#include "cornerstone/registration/register_maps.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "cornerstone/landmarks/crop.h"
#include "cornerstone/registration/corner_matching.h"
#include "cornerstone/registration/decision.h"
#include "cornerstone/registration/edge_refinement.h"
#include "cornerstone/registration/elastic_score.h"
#include "cornerstone/registration/pose_search.h"
#include "cornerstone/registration/proposals.h"
#include "cornerstone/registration/robot_bodies.h"
#include "cornerstone/registration/wall_search.h"

namespace cornerstone {
namespace {

using Corners = std::vector<CornerLandmark>;

constexpr PairingLimits kMatched{
    0.3, 0.2};  // corners this near under the answer are the same: several sigma of both
constexpr double kMergeSquare_m = 0.25;  // proposals closer than the coarse reach score alike
constexpr std::size_t kMaxYaws = 6;      // walls at right angles allow four
constexpr double kMergeAngle_rad = 3 * M_PI / 180;
constexpr double kPriorStep_m = 0.4;  // of the poses tried around a prior: inside the climb's reach
constexpr double kPriorStep_rad = 4 * M_PI / 180;

double overlapOf(const EvidenceGrid& reference, const EvidenceGrid& current, const Pose2& pose) {
  const Eigen::Matrix2f rotation = pose.rotation().cast<float>();
  const Eigen::Vector2f shift = pose.translation().cast<float>();
  const auto squares = current.knownSquares();
  const auto known = std::count_if(squares.begin(), squares.end(), [&](const Eigen::Vector2f& p) {
    return reference.known(rotation * p + shift);
  });
  return squares.empty() ? 0 : static_cast<double>(known) / static_cast<double>(squares.size());
}

// The prior, what the paper's matching makes of it, and poses all around it.
std::vector<Pose2> proposeAround(const Pose2& prior, const Corners& there, const Corners& here,
                                 const RegistrationParams& params) {
  std::vector<Pose2> poses{prior};
  for (int round = 0; round < 2; ++round) {
    const CornerPairs pairs =
        pairNearest(there, here, poses.back(), {params.match_distance_m, params.prior_angle_rad});
    const auto solved = solvePairs(there, here, pairs, poses.back());
    if (solved) poses.push_back(*solved);
  }
  const int steps = static_cast<int>(std::ceil(params.prior_radius_m / kPriorStep_m));
  const int turns = static_cast<int>(std::ceil(params.prior_angle_rad / kPriorStep_rad));
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      for (int k = -turns; k <= turns; ++k) {
        poses.push_back({prior.x_m + i * kPriorStep_m, prior.y_m + j * kPriorStep_m,
                         wrapAngle(prior.yaw_rad + k * kPriorStep_rad)});
      }
    }
  }
  return poses;
}

std::vector<Pose2> propose(const PreparedMap& reference, const PreparedMap& current,
                           const RegistrationParams& params) {
  const EvidencePair maps{reference.evidence, current.evidence};
  const DirectionMatch directions(maps.reference.directions, maps.current.directions);
  std::vector<Pose2> poses =
      proposeFromCorners(reference.landmarks.corners, current.landmarks.corners, directions);
  WallSearchOptions options;
  options.contradiction = params.coarse_contradiction;
  const std::vector<Pose2> by_walls = proposeFromWalls(maps, directions.peaks(kMaxYaws), options);
  poses.insert(poses.end(), by_walls.begin(), by_walls.end());
  return mergeProposals(poses, maps.current.middle_m, kMergeSquare_m, kMergeAngle_rad);
}

// Far from the prior nothing counts, neither as an answer nor as a rival.
void keepNear(std::vector<Hypothesis>& hypotheses, const Pose2& prior, const RegistrationParams& params) {
  const Eigen::Vector2d origin(0, 0);  // of the current map's frame: what the prior places
  const PoseDistance limits{origin, params.prior_radius_m, params.prior_angle_rad};
  const auto is_far = [&](const Hypothesis& h) { return limits.apart(h.reference_from_current, prior); };
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), is_far), hypotheses.end());
}

// Puts the hypotheses in the order of their elastic scores, best first, and returns the scores.
std::vector<JudgedPose> judgeAndSort(const MapEvidence& there, const MapEvidence& here,
                                     std::vector<Hypothesis>& hypotheses) {
  std::vector<std::pair<PoseScore, Hypothesis>> scored(hypotheses.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(scored.size())), [&](const cv::Range& range) {
    for (auto i = static_cast<std::size_t>(range.start); i < static_cast<std::size_t>(range.end); ++i)
      scored[i] = {scoreElastic(there, here, hypotheses[i].reference_from_current, {}), hypotheses[i]};
  });
  std::stable_sort(scored.begin(), scored.end(), [](const auto& a, const auto& b) {
    return a.first.agree - a.first.contradict > b.first.agree - b.first.contradict;
  });
  std::vector<JudgedPose> judged;
  for (std::size_t i = 0; i < scored.size(); ++i) {
    judged.push_back({scored[i].second.score, scored[i].first});
    hypotheses[i] = scored[i].second;
  }
  return judged;
}

// The lead of the first pose where edges must meet closely: where maps do not bend, that parts a right pose
// from one whose walls are only near.
double closeLead(const EvidencePair& maps, std::vector<Hypothesis> poses, const RegistrationParams& params) {
  const auto closer = [&](const MapEvidence& map) {
    MapEvidence close = map;
    close.fine = EvidenceGrid(map.fine.counts(), map.edges, params.close_reach_m);
    return close;
  };
  const MapEvidence there = closer(maps.reference), here = closer(maps.current);
  settlePoses({there, here}, poses, params);
  std::vector<PoseScore> scores;
  for (const Hypothesis& h : poses) scores.push_back(h.score);
  return leadOf(scores, params.fine_cell_m);
}

// On all edges first: that judges the answer. Around the focus then, where enough is seen there.
std::optional<RefinedPose> refine(const EvidencePair& maps, const Pose2& guess, RefinementOptions options) {
  const EdgeIndex &reference = maps.reference.all_edges, &current = maps.current.all_edges;
  options.cell_m = std::max(maps.reference.cell_m, maps.current.cell_m);
  RefinementOptions everywhere = options;
  everywhere.focus_in_current_m.reset();
  const auto whole = refineOnEdges(reference, current, guess, everywhere);
  if (!whole || !options.focus_in_current_m) return whole;
  auto local = refineOnEdges(reference, current, whole->reference_from_current, options);
  if (!local || local->spread < options.min_spread ||
      PoseDistance{*options.focus_in_current_m, options.first_reach_m, kMergeAngle_rad}.apart(
          local->reference_from_current, whole->reference_from_current))
    return whole;
  local->spread = whole->spread;
  return local;
}

RefinementOptions refinementOptions(const RegistrationHints& hints, const RegistrationParams& params) {
  RefinementOptions options;
  options.first_reach_m = params.refine_reach_m;
  options.focus_in_current_m = hints.focus_in_current_m;
  options.focus_radius_m = params.focus_radius_m;
  options.min_spread = params.min_spread;
  return options;
}

}  // namespace

MapEvidence gatherEvidence(const MapView& view, const RegistrationParams& params) {
  std::vector<EdgePoint> edges = thinEdges(view.landmarks.edges, params.fine_cell_m);
  Eigen::Vector2d middle(0, 0);
  for (const EdgePoint& edge : edges) middle += edge.position_m / static_cast<double>(edges.size());
  EdgeSamples samples = samplesOf(edges);
  const cv::Mat1b& states = view.landmarks.states;
  const cv::Rect known = states.empty() ? cv::Rect() : cv::boundingRect(states);
  SquareCounts counts =
      countSquares(croppedGeometry(view.map.geometry, known), states(known), params.fine_cell_m);
  EvidenceGrid coarse(inLargerSquares(counts, params.coarse_cell_m), thinEdges(edges, params.coarse_cell_m),
                      params.coarse_reach_m);
  EvidenceGrid fine(std::move(counts), edges, params.fine_reach_m);
  std::vector<double> directions = wallDirections(edges);
  return {std::move(coarse),
          std::move(fine),
          std::move(edges),
          std::move(samples),
          middle,
          view.map.geometry.resolution_m,
          std::move(directions),
          EdgeIndex(view.landmarks.edges, params.refine_reach_m / 3),
          view.way_m};
}

RegistrationOutcome registerMaps(const PreparedMap& reference, const PreparedMap& current,
                                 const RegistrationHints& hints, const RegistrationParams& params) {
  if (reference.landmarks.edges.empty()) return {{}, "the reference map has no edges"};
  if (current.landmarks.edges.empty()) return {{}, "the current map has no edges"};
  const MapEvidence &there = reference.evidence, &here = current.evidence;
  const std::vector<Pose2> proposals = hints.prior ? proposeAround(*hints.prior, reference.landmarks.corners,
                                                                   current.landmarks.corners, params)
                                                   : propose(reference, current, params);
  std::vector<Hypothesis> best = searchPoses({there, here}, proposals, params);
  if (hints.prior) keepNear(best, *hints.prior, params);
  const std::vector<JudgedPose> judged = judgeAndSort(there, here, best);
  if (best.empty() || best.front().value <= 0) return {{}, "no pose agrees with both maps"};
  const auto refined =
      refine({there, here}, best.front().reference_from_current, refinementOptions(hints, params));
  if (!refined) return {{}, "too few edges agree"};
  PoseEvidence evidence = weighPoses(judged, params.fine_cell_m);
  // Only what is held against the best pose itself: of its rivals and its lead over them nothing is excused.
  const PoseScore excused = RobotBodies({there, here}, params.robot_radius_m)
                                .excused(judged.front().elastic, best.front().reference_from_current);
  evidence.contradicting_m = excused.contradict * params.fine_cell_m;
  evidence.spread = refined->spread;
  evidence.smaller_map_m =
      static_cast<double>(std::min(there.edges.size(), here.edges.size())) * params.fine_cell_m;
  evidence.with_prior = hints.prior.has_value();
  if (probabilityRight(evidence) < params.min_probability)
    evidence.lead_sigmas = std::max(evidence.lead_sigmas, closeLead({there, here}, best, params));
  if (const auto reason = reasonToRefuse(evidence, params)) return {{}, *reason};

  Registration registration;
  registration.reference_from_current = refined->reference_from_current;
  registration.covariance = refined->covariance;
  registration.matches = pairNearest(reference.landmarks.corners, current.landmarks.corners,
                                     refined->reference_from_current, kMatched);
  registration.rms_m = refined->rms_m;
  registration.overlap = overlapOf(there.coarse, here.coarse, refined->reference_from_current);
  registration.agreement = excused.agreement();
  registration.second_best = evidence.second_best;
  registration.probability = probabilityRight(evidence);
  return {registration, ""};
}

RegistrationOutcome registerMaps(const MapView& reference, const MapView& current,
                                 const RegistrationHints& hints, const RegistrationParams& params) {
  const MapEvidence there = gatherEvidence(reference, params), here = gatherEvidence(current, params);
  return registerMaps(PreparedMap{reference.landmarks, there}, PreparedMap{current.landmarks, here}, hints,
                      params);
}

void describe(ParamVisitor& visitor, RegistrationParams& params) {
  visitor.field("match_distance_m", params.match_distance_m);
  visitor.field("prior_radius_m", params.prior_radius_m);
  visitor.degrees("prior_angle_deg", params.prior_angle_rad);
  visitor.field("coarse_cell_m", params.coarse_cell_m);
  visitor.field("coarse_reach_m", params.coarse_reach_m);
  visitor.field("fine_cell_m", params.fine_cell_m);
  visitor.field("fine_reach_m", params.fine_reach_m);
  visitor.field("close_reach_m", params.close_reach_m);
  visitor.field("contradiction", params.contradiction);
  visitor.field("coarse_contradiction", params.coarse_contradiction);
  visitor.field("different_m", params.different_m);
  visitor.degrees("different_deg", params.different_rad);
  visitor.field("refine_reach_m", params.refine_reach_m);
  visitor.field("focus_radius_m", params.focus_radius_m);
  visitor.field("max_clear_rival", params.max_clear_rival);
  visitor.field("min_agreeing_m", params.min_agreeing_m);
  visitor.field("min_agreeing_share", params.min_agreeing_share);
  visitor.field("min_agreeing_small_map_m", params.min_agreeing_small_map_m);
  visitor.field("min_agreeing_with_prior_m", params.min_agreeing_with_prior_m);
  visitor.field("max_contradicting_share", params.max_contradicting_share);
  visitor.field("robot_radius_m", params.robot_radius_m);
  visitor.field("min_spread", params.min_spread);
  visitor.field("min_probability", params.min_probability);
}

}  // namespace cornerstone
