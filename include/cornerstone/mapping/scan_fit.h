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
  double gate_m = 0.3;              // an end farther from every surface of the map shows something new
  double line_radius_m = 0.25;      // neighbours that give a surface its normal
  double surface_sigma_m = 0.01;    // error of the map's own surfaces
  double loss_sigmas = 2;           // residuals beyond this count less (Cauchy)
  double min_agreeing_share = 0.5;  // of the paired ends must lie on their line within 3 sigma
  int min_matches = 12;             // paired ends
  int max_rounds = 5;               // of pairing and solving
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
};

ScanFit fitScan(const RangeScan& scan, const OccupancyGrid& grid, const PoseEstimate& prior,
                const ScanFitParams& params);

}  // namespace cornerstone
