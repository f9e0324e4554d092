// Views of a world from poses along a robot's route, with cameras spoiled as in life, and their true depth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cornerstone/simulation/camera_rig.h"
#include "cornerstone/simulation/world.h"
#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone::bench {

struct TourName {
  std::string world;  // file in worlds/
  std::string robot;
  std::uint64_t seed = 1;  // of textures and of the cameras' faults
};

struct Tour {
  World world;
  std::vector<Pose2> poses;  // evenly along the route
  std::uint64_t seed = 1;
};
Tour tourOf(const TourName& name, int poses);

struct View {
  StereoImages images;
  cv::Mat1f depth_m;
};
// 2 grey levels of noise, gains that differ by up to 5%, 0.1 px of rectification error.
std::vector<View> renderViews(const Tour& tour, const RigParams& rig);

}  // namespace cornerstone::bench
