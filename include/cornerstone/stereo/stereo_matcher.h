// Dense correlation stereo over two or three rectified cameras: the matching cost of each candidate disparity
// of a reference pixel is summed over the camera pairs before the best is chosen (Okutomi and Kanade, 1993).
//
// census -> plane sweep (cost_sweep.h) -> checks (validation.h) -> sub-pixel and sigma (subpixel.h) ->
// surfaces
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/base/params.h"
#include "cornerstone/stereo/census.h"
#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/subpixel.h"
#include "cornerstone/stereo/validation.h"

namespace cornerstone {

struct StereoImages {  // rectified grey images of one instant and of one size
  cv::Mat1b reference;
  cv::Mat1b right;
  cv::Mat1b top;  // empty: two cameras
};

struct StereoParams {
  // Largest disparity searched; sets the nearest range f B / d: 0.3 m for the default rig (f 80 px, B 0.12
  // m).
  int max_disparity_px = 32;
  // Edge of the finest correlation window, odd, 3 to 7; the others are three and five times it. Smaller: noisier
  // answers. Larger: obstacles grow by up to half of it.
  int window_px = 7;
  // A pixel's best cost must be below this share of its second-best local minimum. 0.8: few and safe; 1: all.
  double largest_cost_ratio = 0.93;
  // Two reference pixels that a second camera would see at one place may differ by this much.
  int left_right_tolerance_px = 1;
  // Answers less certain than this have too little texture (or their cameras disagree): 0.5 px is what
  // whole-pixel matching is worth.
  double largest_sigma_px = 0.3;
  // Edge of the support that sub-pixel answers are averaged over, odd; it stops at depth edges.
  int subpixel_support_px = 7;
  // A surface with a smaller share of the image's pixels is dropped: 1/500 is 38 px of 160x120.
  double smallest_surface_share = 0.002;
  // Neighbours that differ by more are on different surfaces.
  double surface_step_px = 1.0;
};
void describe(ParamVisitor& visitor, StereoParams& params);

// Holds the buffers, so that nothing is allocated frame by frame. Not thread-safe: one matcher a camera rig.
class StereoMatcher {
 public:
  explicit StereoMatcher(const StereoParams& params);  // throws InputError on parameters out of range
  // Throws InputError when the images are empty or differ in size from each other or from the rig.
  Disparity match(const StereoImages& images, const TrinocularRig& rig);

 private:
  void sweep(const StereoImages& images, const TrinocularRig& rig);
  void refine(Disparity& disparity);
  void dropSmallSurfaces(Disparity& disparity);

  StereoParams params_;
  CensusTransform census_;
  cv::Mat1b reference_census_, right_census_, top_census_;
  SweepInput sweep_input_;
  CostSweep cost_sweep_;
  const Winners* winners_ = nullptr;
  Validator validator_;
  SubpixelRefiner refiner_;
  cv::Mat1s surfaces_;
  cv::Mat surface_buffer_;
};

}  // namespace cornerstone
