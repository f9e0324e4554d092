// The frame graph's least squares: all that is known of the key frames in, their poses out. A value of its
// own, so that it can be solved beside the mapper that goes on.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/mapping/frame_match.h"
#include "cornerstone/mapping/odometry_filter.h"

namespace ceres {
class Problem;
}

namespace cornerstone {

struct GraphMatch {
  std::size_t earlier = 0, later = 0;  // frames
  FrameMatch match;
};

// From one frame to the next.
struct GraphStep {
  Pose2 by_odometry;
  Pose2 as_fitted;  // as the scans fitted to the map have it
};

struct GraphWeights {
  double match_weight = 1;      // of each match
  double loss_sigmas = 1;       // of a match as a whole (Cauchy)
  double step_loss_sigmas = 1;  // of odometry
  double fitted_step_sigma_m = 1;
  double fitted_step_sigma_rad = 1;
};

struct GraphProblem {
  std::vector<Pose2> map_from_base;  // of each frame, to begin with; the first is held
  std::vector<GraphStep> steps;      // one less
  std::vector<GraphMatch> matches;
  Eigen::Vector3d rates = Eigen::Vector3d::Zero();
  ScanCalibration calibration;
  double calibration_sigma_per_m = 0;  // 0: nothing is asked of it
  OdometryNoise odometry;
  std::size_t held_matches = 0;  // the last of them, which count in full however far off they begin
  GraphWeights weights;
};

struct GraphSolution {
  std::vector<Pose2> map_from_base;  // of each frame
  Eigen::Vector3d rates = Eigen::Vector3d::Zero();
  ScanCalibration calibration;
  std::vector<GraphMatch> loop;  // matches that it found itself (loop_closure.h)
};

std::optional<GraphSolution> solve(const GraphProblem& problem);  // none: no frame, or no finite solution
double costOf(const GraphProblem& problem);  // half the squares' sum at its beginning, as the losses have it

// The pose of a frame as its matches with earlier ones, where they stand, and the prior have it; the prior
// where there are none.
struct GraphPlacement {
  PoseEstimate prior;
  ScanCalibration calibration;
  double match_weight = 1;
  double loss_sigmas = 1;
};
struct PlacedMatch {
  Pose2 map_from_earlier;
  FrameMatch match;
};
PoseEstimate place(const GraphPlacement& placement, const std::vector<PlacedMatch>& matches);

}  // namespace cornerstone
