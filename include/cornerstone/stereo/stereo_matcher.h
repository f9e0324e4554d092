// Dense correlation stereo over two or three rectified cameras: the matching cost of each candidate disparity of a
// reference pixel is summed over the camera pairs before the best is chosen (Okutomi and Kanade, 1993).
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/base/params.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

struct StereoImages {  // rectified grey images of one instant and of one size
  cv::Mat1b reference;
  cv::Mat1b right;
  cv::Mat1b top;  // empty: two cameras
};

struct StereoParams {
  int max_disparity_px = 32;  // largest disparity searched; sets the nearest range f B / d
  // (the owner of this area adds the rest, each with unit and reason)
};
void describe(ParamVisitor& visitor, StereoParams& params);

// Holds the buffers, so that nothing is allocated frame by frame. Not thread-safe: one matcher a camera rig.
class StereoMatcher {
 public:
  explicit StereoMatcher(const StereoParams& params);  // throws InputError on parameters out of range
  // Throws InputError when the images are empty or differ in size from each other or from the rig.
  Disparity match(const StereoImages& images, const TrinocularRig& rig);

 private:
  StereoParams params_;
};

}  // namespace cornerstone
