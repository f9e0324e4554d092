// Whether the evidence for the best pose singles it out. Everything is judged on both maps: what agrees, what
// contradicts, how far the best different pose stays behind, and whether every direction is held.
//
// The probability of being right is a logistic model of two figures: how much contradicts, and by how many of
// its standard deviations the pose leads the best different one. Fitted to the best poses of 1100 pairs of
// windows (5 to 30 m wide, at random overlap, a third of them of different buildings) of laser maps and of
// 1750 pairs of stereo maps of three simulated worlds, most of them of different ones. No wrong pose came
// above 0.91 there, among as many stereo pairs of other seeds, or among 500 pairs of other laser maps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cornerstone/registration/pose_score.h"
#include "cornerstone/registration/registration_params.h"

namespace cornerstone {

// One pose, in edges of the thinned maps: as a rigid pose, and when neighbourhoods may give way a little.
struct JudgedPose {
  PoseScore rigid;
  PoseScore elastic;
};

struct PoseEvidence {
  double agreeing_m = 0;  // length of wall, mean of both maps; neighbourhoods may give way a little
  double contradicting_m = 0;
  double smaller_map_m = 0;  // length of wall of the map with less
  double lead_sigmas = 0;    // of the rigid pose over the best different one, or over none at all
  double second_best = 0;    // value (agreeing less contradicting) of the best different pose over this one's
  double clear_rival = 0;    // the same of the best different pose that is contradicted as little
  double clear_rival_m = 0;  // length of wall that agrees with such a pose, at most
  double spread = 0;         // weakest over strongest direction of the refinement's information
  bool with_prior = false;   // only poses near a prior were looked at
};

// By how many standard deviations the first of several rigid poses leads the best of the others, or no pose.
double leadOf(const std::vector<PoseScore>& poses, double square_m);

// The evidence for the first of several different poses, best elastic score first, in squares of square_m.
PoseEvidence weighPoses(const std::vector<JudgedPose>& poses, double square_m);

double probabilityRight(const PoseEvidence& evidence);

// In words why the pose must be refused; empty: it stands.
std::optional<std::string> reasonToRefuse(const PoseEvidence& evidence, const RegistrationParams& params);

}  // namespace cornerstone
