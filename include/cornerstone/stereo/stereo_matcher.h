// Dense correlation stereo over two or three rectified cameras: the matching cost of each candidate disparity
// of a reference pixel is summed over the camera pairs before the best is chosen (Okutomi and Kanade, 1993).
//
// census -> plane sweep (cost_sweep.h) -> checks (validation.h) -> sub-pixel, sigma (subpixel.h) -> surfaces
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
  // Largest disparity searched; sets the nearest range f B / d: 0.3 m for the default rig (f 80 px,
  // B 0.12 m).
  int max_disparity_px = 32;
  // Edge of the finest correlation window, odd, 3 to 7; the others are three and five times it. Smaller:
  // noisier answers. Larger: obstacles grow by up to half of it, corners get round. 0: an eightieth of the
  // image's width, made odd, so that it covers much the same angle at every size: 3 at 160 px, 5 at 320, 7
  // from 480 on.
  int window_px = 0;
  // Between a pixel's best and second-best local minimum, in standard deviations of the cost's noise. 0: any
  // winner will do; 2: safer, a twentieth fewer answers on clean images and a fifth fewer on noisy ones.
  double smallest_margin_sigmas = 1.5;
  // The best cost must be this many standard deviations below that of unrelated images: the lowest of a
  // hundred random costs is 2.5 below, and neighbours share theirs. Bare walls fail here; with 5, one in four
  // noisy ones keeps a blob.
  double smallest_gain_sigmas = 6;
  // Beside a depth edge the other side's disparity must cost this many times the pixel's own in 3 x 3 px
  // (else surfaces grow over their surroundings). 1: any better; 3: nearly every pixel beside an edge is
  // dropped, thin things with it.
  double smallest_edge_cost_ratio = 1.5;
  // Share of census bits that may differ in the finest window at the winner; 0.5 is chance. Keeps surfaces
  // from growing over bare walls beside them. Lower: fewer answers through noise.
  double largest_own_share = 0.4;
  // Two reference pixels that a second camera would see at one place may differ by this much.
  int left_right_tolerance_px = 1;
  // Answers less certain than this have too little texture (or their cameras disagree): at 0.4 px two in
  // three are still within that.
  double largest_sigma_px = 0.4;
  // Edge of the support that sub-pixel answers are averaged over, odd; it stops at depth edges. 0: two less
  // than the window (the scan averages columns again, so that width is all it would cost).
  int subpixel_support_px = 0;
  // A surface with a smaller share of the image's pixels is dropped: 0.4% is 77 px of 160x120. Chance makes
  // blobs of half that on bare walls; a chair leg 4 px wide and 30 high is 120 px.
  double smallest_surface_share = 0.004;
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
  // The same into an answer that is used again and again.
  void match(const StereoImages& images, const TrinocularRig& rig, Disparity& disparity);

 private:
  int windowFor(int image_width_px) const;
  int supportFor(int image_width_px) const;
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
