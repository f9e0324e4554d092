// The matchers that the stereo tables compare.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone::bench {

struct Matcher {
  std::string name;
  std::function<void(const StereoImages&, Disparity&)> match;  // into an answer that is used again and again
};

// cornerstone with so many cameras, default parameters but for the range searched and the threads.
Matcher cornerstoneMatcher(const TrinocularRig& rig, int max_disparity_px, int cameras, int threads = 1);
// StereoBM and StereoSGBM on the reference and right image (peers.h).
Matcher bmMatcher(int max_disparity_px);
Matcher sgbmMatcher(int max_disparity_px);

// cornerstone with the rig's third camera, if it has one, and with two; the peers.
std::vector<Matcher> allMatchers(const TrinocularRig& rig, int max_disparity_px);

}  // namespace cornerstone::bench
