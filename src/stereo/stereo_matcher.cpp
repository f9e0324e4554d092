#include "cornerstone/stereo/stereo_matcher.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "cornerstone/base/errors.h"
#include "cornerstone/stereo/marks.h"

namespace cornerstone {
namespace {

constexpr int kMaxDisparity_px = 1024;  // far above any camera's use; keeps costs and disparities in 16 bits
constexpr int kSmallestWindow_px = 3, kLargestWindow_px = 7;  // larger sums would not fit 16 bits
constexpr int kSmallestDerivedWindow_px = 5;                  // with 3, answers are twice as noisy
constexpr int kWindowsAcross = 80;  // of the image's width; about a degree of a view of 90
constexpr int kMostThreads = 64;
// A gap may be as long as the windows of the pixels at its ends, so that all of it has been looked at from
// one of them. On photographs half: an eightieth fewer answers, a twenty-fifth more missed columns; double:
// as many more answers, a twentieth more of which are wrong.
constexpr int kGapWindows = 2;
// Of the coarse level, in its pixels: processors search so many at once, and what is nearer than the range
// of the large images must not look as if it were not there.
constexpr int kCoarseDisparities_px = 32;

// An odd number within the range, or 0: derived from the image's width.
void requireOddOrNone(int value, const std::pair<int, int>& range, const std::string& name) {
  if (value == 0) return;
  requireWithin(value, range.first, range.second, name);
  if (value % 2 == 0) throw InputError(name + " must be odd");
}

void requireUsable(const StereoParams& params) {
  requireWithin(params.max_disparity_px, 1, kMaxDisparity_px, "max_disparity_px");
  requireOddOrNone(params.window_px, {kSmallestWindow_px, kLargestWindow_px}, "window_px");
  requireWithin(params.smallest_margin_share, 0, 4, "smallest_margin_share");
  requireWithin(params.smallest_edge_cost_ratio, 0, 100, "smallest_edge_cost_ratio");
  requireWithin(params.largest_own_share, 0, 1, "largest_own_share");
  requireWithin(params.left_right_tolerance_px, 0, kMaxDisparity_px, "left_right_tolerance_px");
  requirePositive(params.largest_sigma_px, "largest_sigma_px");
  requireOddOrNone(params.subpixel_support_px, {1, 31}, "subpixel_support_px");
  requireWithin(params.smallest_surface_share, 0, 1, "smallest_surface_share");
  requireWithin(params.strong_product, 0, 1000, "strong_product");
  requireWithin(params.smallest_strong_windows, 0, 1000, "smallest_strong_windows");
  requirePositive(params.surface_step_px, "surface_step_px");
  requireWithin(params.threads, 1, kMostThreads, "threads");
}

std::string textOf(cv::Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

StereoParams coarseOf(StereoParams params) {
  const int px_per_round = CoarseFill::kFactor * kCoarseDisparities_px;
  params.max_disparity_px =
      (params.max_disparity_px + px_per_round - 1) / px_per_round * kCoarseDisparities_px;
  params.largest_sigma_px /= CoarseFill::kFactor;
  params.coarse_level = false;
  return params;
}

}  // namespace

void requireUsable(const StereoImages& images, const TrinocularRig& rig) {
  const auto require = [&](const cv::Mat1b& image, const std::string& name) {
    if (image.empty()) throw InputError(name + " image is empty");
    if (image.size() != rig.image_size_px)
      throw InputError(name + " image is " + textOf(image.size()) + ", expected " +
                       textOf(rig.image_size_px));
  };
  require(images.reference, "reference");
  require(images.right, "right");
  if (!images.top.empty()) require(images.top, "top");
  if (!images.top.empty() && !rig.top_shift)
    throw InputError("top image given, but the rig has no third camera");
}

StereoMatcher::StereoMatcher(const StereoParams& params) : params_(params) {
  requireUsable(params);
  workers_ = std::make_unique<Workers>(params.threads);
  if (params.coarse_level) coarse_matcher_ = std::make_unique<StereoMatcher>(coarseOf(params));
}

Disparity StereoMatcher::match(const StereoImages& images, const TrinocularRig& rig) {
  Disparity disparity;
  match(images, rig, disparity);
  return disparity;
}

void StereoMatcher::match(const StereoImages& images, const TrinocularRig& rig, Disparity& disparity) {
  requireUsable(images, rig);
  disparity.rig = rig;
  sweep(images, rig);
  validator_.check({*winners_, sweep_input_},
                   {params_.smallest_margin_share, params_.strong_product, params_.smallest_edge_cost_ratio,
                    params_.largest_own_share, params_.left_right_tolerance_px},
                   *workers_, disparity.rejection);
  refine(disparity);
  dropSmallSurfaces(disparity);
  outline_check_.check(*winners_, sweep_input_, *workers_, disparity);
  fillFromCoarse(images, disparity);
  fillGaps(disparity);
}

int StereoMatcher::largest_px(cv::Size size) const {
  if (!coarse_matcher_ || !CoarseFill::suits(size)) return params_.max_disparity_px;
  return std::max(params_.max_disparity_px, CoarseFill::kFactor * coarse_matcher_->params_.max_disparity_px);
}

int StereoMatcher::windowFor(int image_width_px) const {
  if (params_.window_px > 0) return params_.window_px;
  const int odd_px = image_width_px / kWindowsAcross / 2 * 2 + 1;
  return std::clamp(odd_px, kSmallestDerivedWindow_px, kLargestWindow_px);
}

int StereoMatcher::supportFor(int image_width_px) const {
  return params_.subpixel_support_px > 0 ? params_.subpixel_support_px : windowFor(image_width_px);
}

void StereoMatcher::sweep(const StereoImages& images, const TrinocularRig& rig) {
  const int disparities = CostSweep::disparitiesFor(params_.max_disparity_px);
  reference_.compute(images.reference, *workers_);
  right_.compute(images.right, *workers_);
  sweep_input_.reference_image = &images.reference;
  sweep_input_.reference = &reference_;
  sweep_input_.views[0].prepare(right_, rig.right_shift, disparities);
  sweep_input_.view_count = 1;
  if (!images.top.empty()) {
    top_.compute(images.top, *workers_);
    sweep_input_.views[1].prepare(top_, *rig.top_shift, disparities);
    sweep_input_.view_count = 2;
  }
  sweep_input_.max_disparity_px = params_.max_disparity_px;
  sweep_input_.window_px = windowFor(images.reference.cols);
  winners_ = &cost_sweep_.run(sweep_input_, *workers_);
}

void StereoMatcher::refine(Disparity& disparity) {
  refiner_.refine(
      {winners_, &disparity.rejection, sweep_input_.view_count, sweep_input_.window_px, workers_.get()},
      {supportFor(disparity.rejection.cols)}, disparity.disparity_px, disparity.sigma_px);
  const auto largest_sigma = static_cast<float>(params_.largest_sigma_px);
  workers_->share(disparity.rejection.rows, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const float* sigmas_px = disparity.sigma_px[y];
      for (int x = 0; x < disparity.rejection.cols; ++x)
        if (sigmas_px[x] > largest_sigma) reject(disparity, {x, y}, Rejection::kTexture);
    }
  });
}

void StereoMatcher::matchCoarse(const StereoImages& images, const TrinocularRig& rig) {
  CoarseFill::shrink(images.reference, coarse_images_.reference);
  CoarseFill::shrink(images.right, coarse_images_.right);
  if (images.top.empty())
    coarse_images_.top.release();
  else
    CoarseFill::shrink(images.top, coarse_images_.top);
  TrinocularRig coarse_rig = rig;
  coarse_rig.image_size_px = coarse_images_.reference.size();
  coarse_matcher_->match(coarse_images_, coarse_rig, coarse_);
}

void StereoMatcher::fillFromCoarse(const StereoImages& images, Disparity& disparity) {
  const cv::Size size = images.reference.size();
  if (!coarse_matcher_ || !CoarseFill::suits(size)) return;
  const int window_px = coarse_matcher_->windowFor(size.width / CoarseFill::kFactor);
  if (!coarse_fill_.findSilent(disparity.rejection, window_px, *workers_)) return;
  matchCoarse(images, disparity.rig);
  coarse_fill_.fill({coarse_, coarse_matcher_->sweep_input_, params_.smallest_edge_cost_ratio,
                     static_cast<float>(params_.surface_step_px)},
                    *workers_, disparity);
}

void StereoMatcher::fillGaps(Disparity& disparity) {
  const GapParams params{kGapWindows * sweep_input_.window_px, static_cast<float>(params_.surface_step_px)};
  gap_fill_.fill({*winners_, sweep_input_, *workers_}, params, disparity);
}

void StereoMatcher::dropSmallSurfaces(Disparity& disparity) {
  const auto pixels = static_cast<double>(disparity.rejection.total());
  const int window_area = sweep_input_.window_px * sweep_input_.window_px;
  const SurfaceParams params{static_cast<int>(params_.smallest_surface_share * pixels),
                             static_cast<int>(params_.smallest_strong_windows * window_area),
                             static_cast<float>(params_.surface_step_px)};
  surfaces_.judge(disparity.disparity_px, validator_.evidence(), params, verdicts_);
  for (int y = 0; y < verdicts_.rows; ++y) {
    const std::uint8_t *verdicts = verdicts_[y], *evidence = validator_.evidence()[y];
    forEachMarked(verdicts, verdicts_.cols, [&](int x) {
      const bool flat = evidence[x] == static_cast<std::uint8_t>(Evidence::kFlat);
      const bool small = verdicts[x] == SurfaceFilter::kSmall;
      reject(disparity, {x, y},
             flat    ? Rejection::kTexture
             : small ? Rejection::kSurface
                     : Rejection::kUniqueness);
    });
  }
}

}  // namespace cornerstone
