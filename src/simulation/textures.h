// Procedural surfaces: grey textures made from a seed, of natural size, that repeat without a seam from left
// to right. Contrast as in real rooms: plaster has a grain of a few grey levels over several spatial
// frequencies, scuffs near the floor and a slow change of shade; nothing is there to help a correlator.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "cornerstone/simulation/world.h"

namespace cornerstone {

struct Texture {
  cv::Mat1b grey;  // row 0: the top
  double width_m = 1;
  double height_m = 1;
};

constexpr int kPosterColumns = 4, kPosterRows = 4;  // different posters in the one poster texture

Texture makeTexture(Material material, std::uint64_t seed);

}  // namespace cornerstone
