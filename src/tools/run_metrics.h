// How good a recorded run was, against its ground truth.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cornerstone/simulation/true_surfaces.h"
#include "tools/run_recording.h"

namespace cornerstone {

struct MapAccuracy {
  std::size_t occupied = 0;       // occupied cells
  std::size_t occupied_true = 0;  // of these, within 0.10 m of a true surface
  std::size_t seen = 0;           // points of true surfaces the robot's cameras saw
  std::size_t seen_mapped = 0;    // of these, within 0.10 m of an occupied cell
};

// The robot's last map against the world. The map's frame is placed where the robot truly stood when its map
// began: whatever the map drifts from there counts against it.
MapAccuracy mapAccuracy(const RunRecording& run, const std::string& robot, const TrueSurfaces& surfaces,
                        const Sight& sight);

struct RelativePoseError {
  double distance_m = 0;
  double angle_deg = 0;
};
// The pose of `other` in `reference`'s base frame through tf against the truth, at a time; empty: tf does not
// know it.
std::optional<RelativePoseError> relativePoseError(const RunRecording& run, const std::string& reference,
                                                   const std::string& other, double time_s);

// world_from_base between the recorded poses; empty before the first or after the last.
std::optional<Pose2> truthAt(const RobotRecording& robot, double time_s);

// world_from_map as mapAccuracy places it; empty when tf never knew the robot's map.
std::optional<Pose2> worldFromMap(const RunRecording& run, const std::string& robot);

// All figures of the run: the JSON that evaluate_run and the demo print.
nlohmann::json evaluateRun(const RunRecording& run, const Sight& sight);

}  // namespace cornerstone
