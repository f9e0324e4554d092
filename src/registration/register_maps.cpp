#include "cornerstone/registration/register_maps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "cornerstone/registration/edge_refinement.h"
#include "cornerstone/registration/pose_search.h"
#include "cornerstone/registration/proposals.h"

namespace cornerstone {
namespace {

MapEvidence evidenceOf(const MapView& view, const RegistrationParams& params) {
  const cv::Mat1b states = cellStates(view.map, {});
  std::vector<EdgePoint> edges = thinEdges(view.landmarks.edges, params.fine_cell_m);
  Eigen::Vector2d middle(0, 0);
  for (const EdgePoint& edge : edges) middle += edge.position_m / static_cast<double>(edges.size());
  std::vector<EdgeSample> samples = samplesOf(edges);
  return {EvidenceGrid(view.map, states, edges, params.coarse_cell_m, params.coarse_reach_m),
          EvidenceGrid(view.map, states, edges, params.fine_cell_m, params.fine_reach_m), std::move(edges),
          std::move(samples), middle};
}

double overlapOf(const EvidenceGrid& reference, const EvidenceGrid& current, const Pose2& pose) {
  const Eigen::Matrix2f rotation = pose.rotation().cast<float>();
  const Eigen::Vector2f shift = pose.translation().cast<float>();
  const auto squares = current.knownSquares();
  const auto known = std::count_if(squares.begin(), squares.end(), [&](const Eigen::Vector2f& p) {
    return reference.known(rotation * p + shift);
  });
  return squares.empty() ? 0 : static_cast<double>(known) / static_cast<double>(squares.size());
}

std::vector<std::pair<int, int>> matchingCorners(const MapView& reference, const MapView& current,
                                                 const Pose2& pose) {
  std::vector<std::pair<int, int>> matches;
  for (std::size_t c = 0; c < current.landmarks.corners.size(); ++c) {
    const CornerLandmark& here = current.landmarks.corners[c];
    const Pose2 expected = pose * here.pose;
    double best = 0.3;
    int partner = -1;
    for (std::size_t r = 0; r < reference.landmarks.corners.size(); ++r) {
      const CornerLandmark& there = reference.landmarks.corners[r];
      const double distance = (there.pose.translation() - expected.translation()).norm();
      if (there.kind != here.kind || distance >= best ||
          std::abs(wrapAngle(there.pose.yaw_rad - expected.yaw_rad)) > 0.3)
        continue;
      best = distance;
      partner = static_cast<int>(r);
    }
    if (partner >= 0) matches.emplace_back(partner, static_cast<int>(c));
  }
  return matches;
}

std::optional<Registration> refuse(std::string* refusal, const std::string& why) {
  if (refusal != nullptr) *refusal = why;
  return std::nullopt;
}

}  // namespace

std::optional<Registration> registerMaps(const MapView& reference, const MapView& current,
                                         const std::optional<Pose2>& prior, const RegistrationParams& params,
                                         std::string* refusal) {
  if (reference.landmarks.edges.empty() || current.landmarks.edges.empty())
    return refuse(refusal, "a map has no edges");
  const MapEvidence there = evidenceOf(reference, params), here = evidenceOf(current, params);
  const DirectionMatch directions(reference.landmarks.edges, current.landmarks.edges);
  std::vector<Pose2> proposals =
      proposeFromCorners(reference.landmarks.corners, current.landmarks.corners, directions);
  proposals = mergeProposals(proposals, here.middle_m, 0.25, 3 * M_PI / 180);
  (void)prior;
  const std::vector<Hypothesis> best = searchPoses(there, here, proposals, params);
  if (best.empty()) return refuse(refusal, "no pair of corners proposes a pose");
  const Hypothesis& winner = best.front();
  const double second = best.size() > 1 ? std::max(best[1].value, 0.0) / winner.value : 0;
  const EdgeIndex reference_index(reference.landmarks.edges, params.refine_reach_m),
      current_index(current.landmarks.edges, params.refine_reach_m);
  RefinementOptions options;
  options.first_reach_m = params.refine_reach_m;
  const auto refined = refineOnEdges(reference_index, current_index, winner.reference_from_current, options);
  const double meters = winner.score.agree * params.fine_cell_m;
  if (getenv("DBG"))
    std::printf("DBG props %zu value %.0f second %.3f agreement %.3f meters %.1f spread %.3f overlap %.2f\n",
                proposals.size(), winner.value, second, winner.score.agreement(), meters,
                refined ? refined->spread : 0,
                overlapOf(there.coarse, here.coarse, winner.reference_from_current));
  if (!refined) return refuse(refusal, "too few edges agree");
  Registration registration;
  registration.reference_from_current = refined->reference_from_current;
  registration.covariance = refined->covariance;
  registration.rms_m = refined->rms_m;
  registration.second_best = second;
  registration.agreement = winner.score.agreement();
  registration.overlap = overlapOf(there.coarse, here.coarse, refined->reference_from_current);
  registration.matches = matchingCorners(reference, current, refined->reference_from_current);
  if (getenv("FORCE")) return registration;
  if (meters < params.min_agreeing_m) return refuse(refusal, "too little wall agrees");
  if (registration.agreement < params.min_agreement) return refuse(refusal, "the maps contradict each other");
  if (second > params.max_second_best) return refuse(refusal, "another pose fits nearly as well");
  if (refined->spread < params.min_spread) return refuse(refusal, "the walls leave one direction open");
  return registration;
}

void describe(ParamVisitor& visitor, RegistrationParams& params) {
  visitor.field("match_distance_m", params.match_distance_m);
}

}  // namespace cornerstone
