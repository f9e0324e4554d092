// Dense correlation stereo over two or three rectified cameras: the matching cost of each candidate disparity
// of a reference pixel is summed over the camera pairs before the best is chosen (Okutomi and Kanade, 1993).
//
// features (gradient_features.h) -> search (cost_sweep.h) -> checks (validation.h) -> sub-pixel and sigma
// (subpixel.h) -> surfaces, outlines -> a coarse level where all is silent (coarse_fill.h) -> gaps
// (gap_fill.h)
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "cornerstone/base/params.h"
#include "cornerstone/base/workers.h"
#include "cornerstone/stereo/coarse_fill.h"
#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/gap_fill.h"
#include "cornerstone/stereo/outline_check.h"
#include "cornerstone/stereo/subpixel.h"
#include "cornerstone/stereo/surfaces.h"
#include "cornerstone/stereo/validation.h"

namespace cornerstone {

struct StereoImages {  // rectified grey images of one instant and of one size
  cv::Mat1b reference;
  cv::Mat1b right;
  cv::Mat1b top;  // empty: two cameras
};

// Throws InputError when the images are empty or differ in size from each other or from the rig.
void requireUsable(const StereoImages& images, const TrinocularRig& rig);

struct StereoParams {
  // Largest disparity searched; sets the nearest range f B / d: 0.3 m for the default rig (f 80 px,
  // B 0.12 m).
  int max_disparity_px = 32;
  // Edge of the correlation window, odd, 3 to 7. Smaller: noisier answers. Larger: obstacles grow by up to
  // half of it, corners get round. 0: an eightieth of the image's width, made odd, and at least 5: 5 below
  // 480 px, 7 from there on.
  int window_px = 0;
  // Between a pixel's best and second-best disparity, in costs of a pixel that has nothing to do with the
  // other, summed over all paths: patterns and most of bare walls fail here. Half: a twentieth more wrong
  // answers on photographs; double: a hundredth fewer answers there.
  double smallest_margin_share = 0.3;
  // Beside a depth edge the other side's disparity must cost this many times the pixel's own in 3 x 3 px, or
  // more than it for pixels beyond doubt (else surfaces grow over their surroundings). On photographs half: a
  // third more phantom columns and wrong answers; double: a fortieth fewer answers, an eighth more missed
  // columns.
  double smallest_edge_cost_ratio = 1.4;
  // Mean cost of the window's pixels at the winner, of that of unrelated pixels. Lower: fewer answers through
  // noise.
  double largest_own_share = 0.8;
  // Two reference pixels that a second camera would see at one place may differ by this much.
  int left_right_tolerance_px = 1;
  // Answers less certain than this are of no use: at 3 m range and the default rig's 3.2 px, 1.5 px are the
  // difference between 2 and 5.6 m. Through 4 grey levels of noise, half: a quarter fewer answers;
  // double: a thirtieth more.
  double largest_sigma_px = 1.5;
  // Edge of the support that sub-pixel answers are averaged over, odd; it stops at depth edges. 0: that of
  // the window.
  int subpixel_support_px = 0;
  // A surface with a smaller share of the image's pixels is dropped: 0.025% is 77 px of 640x480. A chair leg
  // 2 px wide and 30 high is 60 px of 160x120, where smallest_strong_windows asks for more than this. Half:
  // no change on photographs; double: a hundredth more missed columns there.
  double smallest_surface_share = 0.00025;
  // Answers that no bare wall or pattern gives: their margin, as above, times the lead of their window's cost
  // over that of any other disparity, in standard deviations of the cost. Half: blobs on a tenth of bare
  // walls, wrong disparities on patterns; double: a hundredth fewer answers.
  double strong_product = 3;
  // A surface with fewer such pixels is dropped, however large; in areas of the window, whose pixels err
  // together. Half: a fiftieth more wrong answers on photographs; double: a sixteenth more missed columns.
  double smallest_strong_windows = 1;
  // Neighbours that differ by more are on different surfaces.
  double surface_step_px = 1.0;
  // Images from 640 px width on are matched shrunk to a quarter, too, where they are silent over some
  // degrees: near walls have no texture sharp enough for their windows. That level searches to 128 px at
  // least.
  bool coarse_level = true;
  // Processors that one image set may keep busy; the answers are the same with any number. 1 leaves the
  // others to the rest of the robot; more shorten the delay of large images.
  int threads = 1;
};
void describe(ParamVisitor& visitor, StereoParams& params);

// Holds the buffers, so that nothing is allocated frame by frame. Not thread-safe: one matcher a camera rig.
class StereoMatcher {
 public:
  explicit StereoMatcher(const StereoParams& params);  // throws InputError on parameters out of range
  // Throws InputError as requireUsable.
  Disparity match(const StereoImages& images, const TrinocularRig& rig);
  // The same into an answer that is used again and again.
  void match(const StereoImages& images, const TrinocularRig& rig, Disparity& disparity);
  // The largest disparity that images of a size may be given: the coarse level searches farther than the fine
  // one.
  int largest_px(cv::Size size) const;

 private:
  int windowFor(int image_width_px) const;
  int supportFor(int image_width_px) const;
  void sweep(const StereoImages& images, const TrinocularRig& rig);
  void refine(Disparity& disparity);
  void matchCoarse(const StereoImages& images, const TrinocularRig& rig);
  void fillFromCoarse(const StereoImages& images, Disparity& disparity);
  void fillGaps(Disparity& disparity);
  void dropSmallSurfaces(Disparity& disparity);

  StereoParams params_;
  std::unique_ptr<Workers> workers_;
  GradientFeatures reference_, right_, top_;
  SweepInput sweep_input_;
  CostSweep cost_sweep_;
  const Winners* winners_ = nullptr;
  Validator validator_;
  SubpixelRefiner refiner_;
  SurfaceFilter surfaces_;
  GapFill gap_fill_;
  OutlineCheck outline_check_;
  cv::Mat1b verdicts_;
  CoarseFill coarse_fill_;
  std::unique_ptr<StereoMatcher> coarse_matcher_;  // empty: not asked for
  StereoImages coarse_images_;
  Disparity coarse_;
};

}  // namespace cornerstone
