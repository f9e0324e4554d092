// A recorded run of several robots, read back for evaluation and pictures.
#pragma once

#include <tf2/buffer_core.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cornerstone/CornerArray.h"
#include "cornerstone/MapRegistration.h"
#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

struct StampedPose {
  double time_s = 0;
  Pose2 pose;
};

struct StageCounts {  // from the nodelets' diagnostics, the newest of each
  unsigned processed = 0;
  unsigned dropped = 0;
};

struct RobotRecording {
  std::vector<StampedPose> truth;             // world_from_base, rising times
  GridMap map;                                // at the end; empty when none was recorded
  CornerArray landmarks;                      // at the end
  std::map<std::string, StageCounts> stages;  // by stage: stereo, mapper, registration
  std::optional<unsigned> collisions;
};

struct RunRecording {
  std::string path;  // of the bag
  std::string world_yaml;
  std::map<std::string, RobotRecording> robots;
  std::vector<MapRegistration> registrations;  // all, in order
  std::vector<float> real_time_factors;
  std::shared_ptr<tf2::BufferCore> tf;
};

// A bag, or a folder that holds run.bag. InputError naming the file when it cannot be read or holds no ground
// truth.
RunRecording readRun(const std::string& bag_or_folder);

// target_from_source at a time; empty where tf does not know it.
std::optional<Pose2> transformAt(const RunRecording& run, const std::string& target,
                                 const std::string& source, double time_s);

}  // namespace cornerstone
