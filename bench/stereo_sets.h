// Photographs with dense true disparity that the user names: scripts/bench.sh --stereo-sets FOLDER...
#pragma once

#include <string>
#include <vector>

namespace cornerstone::bench {

// Each folder holds reference.png, right.png, perhaps top.png (equal baselines: a reference pixel (x, y) is
// seen at (x - d, y) on the right and at (x, y + d) in the top camera), disparity.png (256 x px, 0 unknown)
// and visible.png (seen by all cameras). Throws InputError naming what is missing.
void stereoSetsPart(const std::vector<std::string>& folders);

}  // namespace cornerstone::bench
