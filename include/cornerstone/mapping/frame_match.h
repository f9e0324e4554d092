// What two looks at the same walls say of the robot's motion between them and of the sensor's calibration.
//
// Pieces of the later look, carried into the earlier one, are held against the piece seen there in the same
// direction; Gauss-Newton moves the later frame until the distances along the normals are least (Cauchy
// weights). The distances also depend on the calibration c = (offset, slope): the result is the quadratic
//   |U (x - z, c) + u|^2     x: earlier_from_later
// which the graph minimises together with all others. No answer when too few pieces meet or too few agree.
#pragma once

#include <cmath>
#include <optional>

#include "cornerstone/mapping/key_frame.h"

namespace cornerstone {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

struct FrameMatchParams {
  double gate_m = 0.4;         // between pieces that may be one wall; half of it once they begin to agree
  double loss_sigmas = 0.5;    // residuals beyond count less (Cauchy): stereo's errors have long tails
  double wall_sigma_m = 0.01;  // of the walls themselves: what looks straight is not quite
  int min_pieces = 25;         // that meet
  double min_agreeing_share = 0.5;  // of the pieces in the other's view, to three sigmas
  double min_normal_cosine = 0.9;   // of the angle between pieces of one wall (26 degrees)
  // Errors of a match that no number of pieces averages away: both looks are bent alike where they see alike.
  double floor_sigma_m = 0.01;
  double floor_sigma_rad = 0.3 * M_PI / 180;
  double floor_calibration_per_m = 0.003;  // 0.03 px over f B = 9.6 px m
};

void describe(ParamVisitor& visitor, FrameMatchParams& params);
void requireValid(const FrameMatchParams& params);  // throws InputError naming the parameter

struct FrameMatch {
  Pose2 earlier_from_later;
  Matrix5d sqrt_information = Matrix5d::Zero();  // U
  Vector5d offset = Vector5d::Zero();            // u
  int pieces = 0;
};

// Where the search begins.
struct FrameMatchStart {
  Pose2 earlier_from_later;  // within the gate of the truth
  ScanCalibration calibration;
};

std::optional<FrameMatch> matchFrames(const KeyFrame& earlier, const KeyFrame& later,
                                      const FrameMatchStart& start, const FrameMatchParams& params);

}  // namespace cornerstone
