#include "cornerstone/stereo/stereo_matcher.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr int kMaxDisparity_px = 1024;  // far above any camera's use; keeps costs and disparities in 16 bits
constexpr int kSmallestWindow_px = 3, kLargestWindow_px = 7;  // larger sums would not fit 16 bits
constexpr int kWindowsAcross = 80;    // of the image's width; about a degree of a view of 90
constexpr double kSurfaceUnits = 16;  // of a pixel, for the surface search

// An odd number within the range, or 0: derived from the image's width.
void requireOddOrNone(int value, const std::pair<int, int>& range, const std::string& name) {
  if (value == 0) return;
  requireWithin(value, range.first, range.second, name);
  if (value % 2 == 0) throw InputError(name + " must be odd");
}

void requireUsable(const StereoParams& params) {
  requireWithin(params.max_disparity_px, 1, kMaxDisparity_px, "max_disparity_px");
  requireOddOrNone(params.window_px, {kSmallestWindow_px, kLargestWindow_px}, "window_px");
  requireWithin(params.smallest_margin_sigmas, 0, 100, "smallest_margin_sigmas");
  requireWithin(params.smallest_gain_sigmas, 0, 100, "smallest_gain_sigmas");
  requireWithin(params.smallest_edge_cost_ratio, 0, 100, "smallest_edge_cost_ratio");
  requireWithin(params.largest_own_share, 0, 1, "largest_own_share");
  requireWithin(params.left_right_tolerance_px, 0, kMaxDisparity_px, "left_right_tolerance_px");
  requirePositive(params.largest_sigma_px, "largest_sigma_px");
  requireOddOrNone(params.subpixel_support_px, {1, 31}, "subpixel_support_px");
  requireWithin(params.smallest_surface_share, 0, 1, "smallest_surface_share");
  requirePositive(params.surface_step_px, "surface_step_px");
}

std::string textOf(cv::Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

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

void reject(Disparity& disparity, int y, int x, Rejection why) {
  disparity.disparity_px(y, x) = 0;
  disparity.sigma_px(y, x) = 0;
  disparity.rejection(y, x) = static_cast<std::uint8_t>(why);
}

}  // namespace

StereoMatcher::StereoMatcher(const StereoParams& params) : params_(params) { requireUsable(params); }

Disparity StereoMatcher::match(const StereoImages& images, const TrinocularRig& rig) {
  Disparity disparity;
  match(images, rig, disparity);
  return disparity;
}

void StereoMatcher::match(const StereoImages& images, const TrinocularRig& rig, Disparity& disparity) {
  requireUsable(images, rig);
  disparity.rig = rig;
  sweep(images, rig);
  validator_.check(
      *winners_, sweep_input_,
      {params_.smallest_margin_sigmas, params_.smallest_gain_sigmas, params_.smallest_edge_cost_ratio,
       params_.largest_own_share, params_.left_right_tolerance_px},
      disparity.rejection);
  refine(disparity);
  dropSmallSurfaces(disparity);
}

int StereoMatcher::windowFor(int image_width_px) const {
  if (params_.window_px > 0) return params_.window_px;
  const int odd_px = image_width_px / kWindowsAcross / 2 * 2 + 1;
  return std::clamp(odd_px, kSmallestWindow_px, kLargestWindow_px);
}

int StereoMatcher::supportFor(int image_width_px) const {
  return params_.subpixel_support_px > 0 ? params_.subpixel_support_px : windowFor(image_width_px) - 2;
}

void StereoMatcher::sweep(const StereoImages& images, const TrinocularRig& rig) {
  census_.apply(images.reference, reference_census_);
  census_.apply(images.right, right_census_);
  sweep_input_.reference_census = &reference_census_;
  sweep_input_.views.clear();
  sweep_input_.views.emplace_back(right_census_, rig.right_shift);
  if (!images.top.empty()) {
    census_.apply(images.top, top_census_);
    sweep_input_.views.emplace_back(top_census_, *rig.top_shift);
  }
  sweep_input_.max_disparity_px = params_.max_disparity_px;
  sweep_input_.window_px = windowFor(images.reference.cols);
  winners_ = &cost_sweep_.run(sweep_input_);
}

void StereoMatcher::refine(Disparity& disparity) {
  refiner_.refine({winners_, &disparity.rejection, sweep_input_.views.size()},
                  {supportFor(disparity.rejection.cols)}, disparity.disparity_px, disparity.sigma_px);
  const auto largest_sigma = static_cast<float>(params_.largest_sigma_px);
  for (int y = 0; y < disparity.rejection.rows; ++y)
    for (int x = 0; x < disparity.rejection.cols; ++x)
      if (disparity.sigma_px(y, x) > largest_sigma) reject(disparity, y, x, Rejection::kTexture);
}

void StereoMatcher::dropSmallSurfaces(Disparity& disparity) {
  disparity.disparity_px.convertTo(surfaces_, CV_16S, kSurfaceUnits);
  const double smallest_px = params_.smallest_surface_share * static_cast<double>(surfaces_.total());
  cv::filterSpeckles(surfaces_, 0, static_cast<int>(smallest_px), params_.surface_step_px * kSurfaceUnits,
                     surface_buffer_);
  for (int y = 0; y < surfaces_.rows; ++y)
    for (int x = 0; x < surfaces_.cols; ++x)
      if (surfaces_(y, x) == 0 && disparity.disparity_px(y, x) > 0)
        reject(disparity, y, x, Rejection::kSurface);
}

}  // namespace cornerstone
