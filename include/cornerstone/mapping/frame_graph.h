// Key frames along the robot's way, tied by odometry and by the walls they share: where a scan fitted to the
// map can only go on from what the map has become, the graph bends the whole way so that all looks agree.
//
// Unknowns: each frame's pose, the three rates of the odometry's systematic drift, and the calibration of the
// sensor, which hold for the whole run. Every frame is matched with earlier ones nearby, old and new
// (frame_match.h); Ceres minimises all of it, the first frame held. Matches of neighbours repeat each other's
// errors, so each counts by `match_weight`; a false one is held off by a Cauchy loss.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/mapping/graph_solver.h"

namespace cornerstone {

struct FrameGraphParams {
  bool use = true;                          // false: no frames are kept, and the map is never drawn anew
  double frame_distance_m = 0.25;           // of the way, or
  double frame_turn_rad = 10 * M_PI / 180;  // of a turn, between key frames
  // Frames farther apart hardly see the same piece of wall alike: the range to which pieces are looked for.
  double match_distance_m = 5;
  double match_turn_rad = 70 * M_PI / 180;  // of a camera with 90 degrees of view
  int match_tries = 24;                     // earlier frames, spread over those nearby
  double match_weight = 0.3;                // a frame meets some ten others, whose errors are partly the same
  double place_weight = 0.3;    // of the same when the newest frame alone is placed: its own error, once
  double loss_sigmas = 2;       // of a match as a whole
  double step_loss_sigmas = 3;  // of odometry: wheels slip
  // Where wheels slip and nothing matches, the scans fitted to the map still tell the step, roughly. Where
  // they see nothing of it (along a corridor) it is odometry's own, with the drift as it was believed then:
  // it must be far vaguer than odometry (3 mm a frame), or the graph holds on to its first guess of the
  // drift.
  double fitted_step_sigma_m = 0.1;
  double fitted_step_sigma_rad = 3 * M_PI / 180;
  int solve_after_frames = 10;    // 2 m of way
  int redraw_looks_per_scan = 2;  // looks drawn anew with each scan, of those that came meanwhile
  double redraw_shift_m = 0.01;   // a map that is off by less is left as it is: a fifth of a cell
  WallPieceParams piece;
  FrameMatchParams match;
};
void describe(ParamVisitor& visitor, FrameGraphParams& params);
void requireValid(const FrameGraphParams& params);  // throws InputError naming the parameter

// Whether frames at these poses may see the same pieces of wall.
bool mayMatch(const Pose2& a, const Pose2& b, const FrameGraphParams& params);

class FrameGraph {
 public:
  FrameGraph(const FrameGraphParams& params, const OdometryNoise& odometry);
  // Whether the robot has gone on far enough since the last frame.
  bool frameDue(const Pose2& odom_from_base) const;
  // A new frame, held against earlier ones nearby; returns its pose as these, where they stand, and the prior
  // have it: the prior where nothing matches.
  PoseEstimate addFrame(const RangeScan& scan, const Pose2& odom_from_base, const PoseEstimate& prior);
  // A look from nearly the same place as the last frame. The newest ten are kept while the robot stays: what
  // they say of things that came or went must not be lost when the map is drawn anew.
  void addLook(const RangeScan& scan, const Pose2& odom_from_base);
  bool solveDue() const;
  GraphProblem beginSolution();  // of all frames so far: to be solved here or beside, then adopted
  // Poses of the frames that the solution knows, and of those added since, moved as the last of these.
  void adopt(const GraphSolution& solution);

  const std::vector<KeyFrame>& frames() const { return frames_; }
  const ScanCalibration& calibration() const { return calibration_; }
  const std::vector<GraphMatch>& matches() const { return matches_; }
  const FrameGraphParams& params() const { return params_; }

 private:
  GraphProblem problem() const;
  std::vector<std::size_t> framesNearby(const Pose2& map_from_base) const;

  FrameGraphParams params_;
  OdometryNoise odometry_;
  std::vector<KeyFrame> frames_;
  std::vector<GraphMatch> matches_;
  Eigen::Vector3d rates_ = Eigen::Vector3d::Zero();
  ScanCalibration calibration_;
  std::size_t solved_frames_ = 0;
};

// The motion that a solution puts on what came after its last frame.
Pose2 correctionOf(const GraphSolution& solution, const std::vector<KeyFrame>& frames);

}  // namespace cornerstone
