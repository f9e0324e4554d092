// Views of a world from poses along a robot's route, with cameras spoiled as in life, and their true depth.
#pragma once

#include <vector>

#include "cornerstone/simulation/camera_rig.h"
#include "cornerstone/simulation/world.h"
#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone::bench {

struct View {
  StereoImages images;
  cv::Mat1f depth_m;
};

// Poses evenly along robot a's route.
std::vector<Pose2> posesOf(const World& world, int count);
// 2 grey levels of noise, gains that differ by up to 5%, 0.1 px of rectification error.
std::vector<View> renderViews(const World& world, const std::vector<Pose2>& poses, const RigParams& rig);

}  // namespace cornerstone::bench
