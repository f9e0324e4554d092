// Parameters of the registration of two maps.
#pragma once

#include <cmath>

#include "cornerstone/base/params.h"

namespace cornerstone {

struct RegistrationParams {
  double match_distance_m = 1.0;  // paper: corners farther apart than 1000 mm are not paired
  // Around a prior, poses of the current map's middle are looked for this far: the paper's limits of
  // odometry.
  double prior_radius_m = 1.0;
  double prior_angle_rad = 20 * M_PI / 180;
  double coarse_cell_m = 0.2;  // of the grid that scores every proposal
  double coarse_reach_m =
      0.5;                   // an edge agrees with another this near: what a corner's yaw error makes of 10 m
  double fine_cell_m = 0.1;  // of the grid that judges the best proposals
  double fine_reach_m = 0.25;  // an edge agrees with another this near: maps bend
  double contradiction =
      1.0;  // an edge on free space counts as much against a pose as an edge on an edge for it
  double different_m = 1.0;  // poses farther apart are different answers: well beyond a bent map's play
  double different_rad = 10 * M_PI / 180;
  double refine_reach_m = 0.3;  // first search radius of the refinement; it shrinks to the edges' scatter
  double max_second_best =
      0.80;  // score of the best different pose over the winner's, above which nothing stands out
  double min_agreement = 0.75;   // agreeing share of the edges that the other map can judge
  double min_agreeing_m = 20.0;  // length of wall that agrees: less may be a coincidence of a few walls
  double min_spread =
      0.05;  // weakest over strongest direction of the information: a corridor has next to none
};
void describe(ParamVisitor& visitor, RegistrationParams& params);

}  // namespace cornerstone
