// Parameters of the registration of two maps.
#pragma once

#include <cmath>

#include "cornerstone/base/params.h"

namespace cornerstone {

struct RegistrationParams {
  // Paper: corners farther apart than 1000 mm are not paired.
  double match_distance_m = 1.0;
  // Around a prior, the current map's origin and yaw are looked for this far: twice the paper's limits of
  // odometry.
  double prior_radius_m = 1.0;
  double prior_angle_rad = 20 * M_PI / 180;
  // Squares and reach of the evidence that scores every proposal: an edge agrees with another of its
  // direction this near, which is what a corner's yaw error makes of 10 m.
  double coarse_cell_m = 0.2;
  double coarse_reach_m = 0.5;
  // Squares and reach of the evidence that judges the best proposals: maps bend by some 0.1 m.
  double fine_cell_m = 0.1;
  double fine_reach_m = 0.25;
  // Reach where the lead over other poses is in doubt: walls that meet meet within a cell or two.
  double close_reach_m = 0.12;
  // An edge on free space counts as much against a pose as an edge on an edge counts for it.
  double contradiction = 1.0;
  // The same on the coarse squares. They forgive what maps bend by, so what contradicts there is wrong: a
  // right pose with little overlap must not drown in wrong ones that lay much of the maps on each other.
  double coarse_contradiction = 3.0;
  // Poses farther apart than this are different answers: beyond a bent map's play.
  double different_m = 1.0;
  double different_rad = 10 * M_PI / 180;
  // First search radius of the refinement; it shrinks to the edges' scatter.
  double refine_reach_m = 0.3;
  // Standard deviation of the weight of the edges around a focus: what a robot sees at once.
  double focus_radius_m = 4.0;
  // Value of a different pose that is contradicted as little as the winner (or next to nothing) over the
  // winner's, above which neither is believed: like offices in a row, or the two wings of a building, differ
  // in how much of them the maps share, and in nothing else. A few walls stand free of contradictions
  // anywhere.
  double max_clear_rival = 0.4;
  // Length of wall that must agree: walls of different buildings agree over 30 m by coincidence where one of
  // the maps is large. Of small maps this share is enough, but never less than a few rooms.
  double min_agreeing_m = 30.0;
  double min_agreeing_share = 0.65;
  double min_agreeing_small_map_m = 20.0;
  // A corner or two agree near a prior over 4 m by coincidence.
  double min_agreeing_with_prior_m = 8.0;
  // Of the walls that both maps can judge: bent maps of one place reach 0.15, large wrong matches begin at
  // 0.16.
  double max_contradicting_share = 0.15;
  // Of the larger robot's body: a thing of its size that one robot saw where the other one has been is taken
  // for the other robot and contradicts nothing.
  double robot_radius_m = 0.25;
  // Weakest over strongest direction of the information: a corridor has next to none along its axis.
  double min_spread = 0.05;
  // Of being right, by a model fitted to many pairs (decision.h): a wrong frame is far worse than none.
  double min_probability = 0.95;
};
void describe(ParamVisitor& visitor, RegistrationParams& params);

}  // namespace cornerstone
