// How good a recorded run was, against its ground truth.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cornerstone/simulation/true_surfaces.h"
#include "tools/run_recording.h"

namespace cornerstone {

struct SightOfSurfaces {
  const TrueSurfaces& surfaces;
  Sight sight;  // a surface point counts as seen within this, unhidden, from any pose of the true path
};

struct MapAccuracy {
  std::size_t occupied = 0;       // occupied cells
  std::size_t occupied_true = 0;  // of these, within 0.10 m of a true surface
  std::size_t seen = 0;           // points of true surfaces the robot's cameras saw
  std::size_t seen_mapped = 0;    // of these, within 0.10 m of an occupied cell
};

// How a map's frame is placed in the world for its evaluation.
enum class Placement {
  kStart,       // where the robot truly stood when its map began: all drift from there counts against the map
  kTrajectory,  // by the least-squares fit of the robot's path in the map to its true path, as is usual for
                // the absolute trajectory error: what counts is the map's own shape
};

// world_from_map; empty when tf never knew the robot's map, or the path is too short (1 m) to be fitted.
std::optional<Pose2> worldFromMap(const RunRecording& run, const std::string& robot, Placement placement);

// The robot's last map, placed in the world, against the true surfaces.
MapAccuracy mapAccuracy(const RunRecording& run, const std::string& robot, const Pose2& world_from_map,
                        const SightOfSurfaces& truth);

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

// All figures of the run: the JSON that evaluate_run and the demo print.
nlohmann::json evaluateRun(const RunRecording& run, const Sight& sight);

}  // namespace cornerstone
