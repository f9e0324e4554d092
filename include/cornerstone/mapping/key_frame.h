// A look that is kept, with what other looks are compared with: short straight pieces of wall.
#pragma once

#include <memory>
#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/bearing_index.h"
#include "cornerstone/scan/scan_calibration.h"

namespace cornerstone {

// The line through a beam's end and its neighbours', in the base frame.
struct WallPiece {
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();          // unit length, towards no side in particular
  double sigma_m = 0;                                        // of the beam's end along the normal
  Eigen::Matrix2d by_calibration = Eigen::Matrix2d::Zero();  // d(point) / d(offset, slope), m per 1/m
  bool valid = false;
};

struct KeptLook {
  std::shared_ptr<const RangeScan>
      scan;  // as it was seen, not corrected; a redraw beside the mapper reads it, too
  Pose2 frame_from_base;
};

struct KeyFrame {
  Pose2 odom_from_base;
  Pose2 map_from_base;
  Pose2 step_as_fitted;  // from the frame before to this one, as the scans fitted to the map have it
  Pose2 base_from_sensor;
  double correlated_beams = 1;
  double calibration_sigma_per_m = 0;
  BearingIndex bearings;          // of the pieces
  std::vector<WallPiece> pieces;  // one a beam
  std::vector<KeptLook> looks;    // the first is the frame's own
};

struct WallPieceParams {
  int beams_each_side = 3;  // make up a piece; about a matching window of stereo
  double max_sigmas = 0.5;  // scatter of its points about the line (neighbours share most of their error) ...
  double max_scatter_m = 0.01;  // ... above this, the roughness of plaster and frames
  double max_range_m = 6;       // farther points of stereo bend lines
  // Error of where in the image a piece lies: a matching window moves it. It shows where walls are seen
  // flatly.
  double bearing_sigma_beams = 1;
  double min_incidence =
      0.17;  // sine of the angle between beam and wall (10 degrees): flatter ones say little
};

void describe(ParamVisitor& visitor, WallPieceParams& params);
void requireValid(const WallPieceParams& params);  // throws InputError naming the parameter

KeyFrame makeKeyFrame(const RangeScan& scan, const Pose2& odom_from_base, const Pose2& map_from_base,
                      const WallPieceParams& params);

}  // namespace cornerstone
