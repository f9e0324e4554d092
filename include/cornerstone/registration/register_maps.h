// The transform between two robots' maps (paper, section 4, and beyond it), or a refusal. Metres, radians.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/mapping/grid_map.h"
#include "cornerstone/registration/pose_score.h"
#include "cornerstone/registration/registration_params.h"

namespace cornerstone {

// What is known of one robot's map; all parts must outlive the call.
struct MapView {
  const GridMap& map;
  const Landmarks& landmarks;
  // Where the map's robot has been, m in the map's frame: the other one may have seen it there. Empty: not
  // known.
  std::vector<Eigen::Vector2d> way_m = {};
};
struct PreparedMap {  // the same with what every attempt would compute anew
  const Landmarks& landmarks;
  const MapEvidence& evidence;
};

struct Registration {
  Pose2 reference_from_current;  // pose of the current map's frame in the reference map's
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // (x, y, yaw), m and rad
  std::vector<std::pair<int, int>> matches;              // indices (reference corner, current corner)
  double rms_m = 0;                                      // of the matched edges after refinement
  double probability = 0;                                // of being right, by the model of decision.h
  double agreement = 0;    // share of the edges that both maps can judge which agree
  double overlap = 0;      // share of the current map's known cells that the reference map knows
  double second_best = 0;  // score of the best different pose over this one's: near 1 is ambiguous
};

// What is known beforehand; empty: any pose is possible, and the whole overlap counts alike.
struct RegistrationHints {
  std::optional<Pose2> prior;  // rough reference_from_current: a shared start, odometry
  // Where in the current map the frame must be right (where the robots are): maps bend, and a pose that is
  // the mean of a whole building is right nowhere. The evidence for the pose stays that of both whole maps.
  std::optional<Eigen::Vector2d> focus_in_current_m;
};

struct RegistrationOutcome {
  std::optional<Registration> registration;  // empty: the evidence does not single out one pose
  std::string refusal;                       // why, in words
};

MapEvidence gatherEvidence(const MapView& view, const RegistrationParams& params);

RegistrationOutcome registerMaps(const PreparedMap& reference, const PreparedMap& current,
                                 const RegistrationHints& hints, const RegistrationParams& params);
RegistrationOutcome registerMaps(const MapView& reference, const MapView& current,
                                 const RegistrationHints& hints, const RegistrationParams& params);

}  // namespace cornerstone
