#include "cornerstone/stereo/subpixel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core/hal/intrin.hpp>

#include "cornerstone/stereo/cost_noise.h"

namespace cornerstone {
namespace {

constexpr int kLanes = 4;
constexpr float kNone_px = -1e4F;
// What the fit does not know is added to every sigma: slant within the windows, rectification, rounding. Half
// of it is right for rendered images, all of it for photographs from calibrated cameras.
constexpr float kModelSigma_px = 0.15F;
constexpr float kLargestStep_px = 1.0F;

struct Fit {
  float ahead_px;  // of the winner: -0.5 .. 0.5
  float sigma_px;
};

Fit fitOf(float before, float middle, float after, const CostNoise& noise) {
  const float step = std::max(std::max(before, after) - middle, 1.F);
  return {std::clamp((before - after) / (2 * step), -0.5F, 0.5F), noise.sigmaAt(middle) / (2 * step)};
}

}  // namespace

void SubpixelRefiner::fitEach(const SubpixelInput& input) {
  const cv::Mat1b& rejection = *input.rejection;
  const Winners& winners = *input.winners;
  const CostNoise noise(input.window_px, input.cameras);
  const cv::Size padded(rejection.cols + 2 * radius_px_ + kLanes, rejection.rows + 2 * radius_px_);
  for (cv::Mat1f* plane : {&disparity_px_, &averaged_px_}) {
    plane->create(padded);
    plane->setTo(kNone_px);
  }
  for (cv::Mat1f* plane : {&weight_, &averaged_weight_}) {
    plane->create(padded);
    plane->setTo(0);
  }
  for (int y = 0; y < rejection.rows; ++y) {
    const std::uint8_t* rejections = rejection[y];
    const short *before = winners.cost_before[y], *cost = winners.cost[y], *after = winners.cost_after[y];
    const short* whole_px = winners.disparity_px[y];
    float *disparities_px = disparity_px_[y + radius_px_] + radius_px_,
          *weights = weight_[y + radius_px_] + radius_px_;
    for (int x = 0; x < rejection.cols; ++x) {
      const Fit fit = fitOf(before[x], cost[x], after[x], noise);
      const bool answered = rejections[x] == 0;
      disparities_px[x] = answered ? static_cast<float>(whole_px[x]) + fit.ahead_px : kNone_px;
      weights[x] = answered ? 1 / (fit.sigma_px * fit.sigma_px) : 0;
    }
  }
}

// Weighted mean of the pixels at -radius .. radius steps that are at most kLargestStep_px from the middle
// one.
void SubpixelRefiner::averageAlong(cv::Point step) {
  const cv::v_float32x4 largest_step = cv::v_setall_f32(kLargestStep_px), least = cv::v_setall_f32(1e-12F);
  for (int y = radius_px_; y < disparity_px_.rows - radius_px_; ++y) {
    for (int x = radius_px_; x + radius_px_ + kLanes <= disparity_px_.cols; x += kLanes) {
      const cv::v_float32x4 middle = cv::v_load(&disparity_px_(y, x));
      cv::v_float32x4 sum = cv::v_setzero_f32(), weights = cv::v_setzero_f32();
      for (int i = -radius_px_; i <= radius_px_; ++i) {
        const int ny = y + i * step.y, nx = x + i * step.x;
        const cv::v_float32x4 ahead = cv::v_load(&disparity_px_(ny, nx)) - middle;
        const cv::v_float32x4 weight = cv::v_load(&weight_(ny, nx)) & (cv::v_abs(ahead) <= largest_step);
        sum += weight * ahead;
        weights += weight;
      }
      cv::v_store(&averaged_px_(y, x), middle + sum / cv::v_max(weights, least));
      cv::v_store(&averaged_weight_(y, x), weights);
    }
  }
  std::swap(disparity_px_, averaged_px_);
  std::swap(weight_, averaged_weight_);
}

void SubpixelRefiner::refine(const SubpixelInput& input, const SubpixelParams& params,
                             cv::Mat1f& disparity_px, cv::Mat1f& sigma_px) {
  const cv::Size size = input.rejection->size();
  radius_px_ = params.support_px / 2;
  fitEach(input);
  const float each_way = static_cast<float>(2 * radius_px_ + 1);
  if (radius_px_ > 0) {
    averageAlong({1, 0});
    averageAlong({0, 1});
  }
  disparity_px.create(size);
  sigma_px.create(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool answered = (*input.rejection)(y, x) == 0;
      const float weight = weight_(y + radius_px_, x + radius_px_) / (each_way * each_way);
      disparity_px(y, x) = answered ? disparity_px_(y + radius_px_, x + radius_px_) : 0;
      sigma_px(y, x) = answered ? std::sqrt(1 / weight + kModelSigma_px * kModelSigma_px) : 0;
    }
  }
}

}  // namespace cornerstone
