// The pose of a scan in the map: beam ends on the surfaces of the grid, odometry as prior.
//
// Each end is paired with the nearest surface point of the grid; a line through that point's neighbours gives
// the normal. Ceres minimises the distances to the lines plus the prior; pairing and solving alternate. In a
// bare corridor nothing is said along it, and the prior decides there, by its covariance. A state says when
// too few ends find a surface or too few of these agree: then odometry is all there is.
#pragma once

#include "cornerstone/mapping/occupancy_grid.h"
#include "cornerstone/mapping/odometry_filter.h"

namespace cornerstone {

struct ScanFitParams {
  double gate_m = 0.2;            // an end farther from every surface of the map shows something new
  double line_radius_m = 0.15;    // neighbours that give a surface its normal; wider rounds corners off
  double surface_sigma_m = 0.02;  // error of the map's own surfaces
  double loss_sigmas = 0.5;  // residuals beyond this count less (Cauchy): stereo's errors have long tails
  double min_agreeing_share = 0.5;  // of the paired ends must lie on their line within 3 sigma
  int min_matches = 12;             // paired ends
  int max_rounds = 5;               // of pairing and solving
  // Only beams on a straight piece of a surface take part: those so many beams to each side lie on one line
  // with them, to so many sigmas; about a matching window of stereo, which rounds edges and corners off
  // differently from every place. 0: all beams.
  int straight_beams = 3;
  double straight_sigmas = 2;
  // What no number of beams averages away in one look: cameras not quite aligned bend each view in the same
  // way. The pose that a look alone tells has at least these errors.
  double look_sigma_m = 0.015;
  double look_sigma_rad = 0.01;
};
void describe(ParamVisitor& visitor, ScanFitParams& params);
void requireValid(const ScanFitParams& params);

enum class FitState {
  kFitted,
  kTooLittle,    // hardly any end lies by a surface of the map: a new area, or nothing seen
  kContradicts,  // ends lie by surfaces but not on them
};

struct ScanFit {
  FitState state = FitState::kTooLittle;
  PoseEstimate pose;  // the prior unless fitted
  int matches = 0;
  double agreeing_share = 0;
  int on_free = 0;               // ends that lie by no surface but on free floor
  double innovation_sigmas = 0;  // how far scan and prior lie apart, in their common sigmas
  // Of all ends that the map knows anything of: those that lie on their line. 1 where it knows hardly any.
  double knownAgreeingShare(int min_known) const {
    const int known = matches + on_free;
    return known < min_known ? 1 : agreeing_share * matches / known;
  }
};

// What a scan is fitted to, and what is known before.
struct ScanFitStart {
  PoseEstimate prior;
  double new_share =
      1;  // of the look: errors repeat from one place (OccupancyGrid::newShare); scales its information
};

ScanFit fitScan(const RangeScan& scan, const OccupancyGrid& grid, const ScanFitStart& start,
                const ScanFitParams& params);

}  // namespace cornerstone
