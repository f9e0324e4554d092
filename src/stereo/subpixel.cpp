#include "cornerstone/stereo/subpixel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cornerstone/stereo/cost_noise.h"
#include "cornerstone/stereo/sweep_kernels.h"

namespace cornerstone {
namespace {

constexpr int kSlack = 16;  // kernels work in whole vectors
constexpr float kLeastWeight = 1e-6F;
constexpr float kNone_px = -1e4F;
// What the fit does not know is added to every sigma: slant within the windows, rectification, rounding.
// Rendered images would do with half of it, photographs want up to 0.15.
constexpr float kModelSigma_px = 0.1F;
constexpr float kLargestStep_px = 1.0F;

}  // namespace

void SubpixelRefiner::fitEach(const SubpixelInput& input, const cv::Range& rows) {
  const cv::Mat1b& rejection = *input.rejection;
  const Winners& winners = *input.winners;
  const CostNoise noise(input.window_px, input.cameras);
  FitRow row;
  row.width = rejection.cols;
  row.noise_share = noise.share();
  row.least_cost = CostNoise::kLeastCost;
  row.none_px = kNone_px;
  for (int y = rows.start; y < rows.end; ++y) {
    row.whole_px = winners.disparity_px[y];
    row.before = winners.cost_before[y];
    row.cost = winners.cost[y];
    row.after = winners.cost_after[y];
    row.rejections = rejection[y];
    row.fits_px = disparity_px_[y + radius_px_] + radius_px_;
    row.weights = weight_[y + radius_px_] + radius_px_;
    sweepKernels().fit(row);
  }
}

// Weighted mean of the pixels at -radius .. radius steps that are at most kLargestStep_px from the middle
// one. `step` in floats.
void SubpixelRefiner::averageAlong(std::ptrdiff_t step, Workers& workers) {
  AverageRow all;
  all.step = step;
  all.radius = radius_px_;
  all.width = disparity_px_.cols - 2 * radius_px_ - kSlack;
  all.largest_step = kLargestStep_px;
  workers.share(disparity_px_.rows - 2 * radius_px_, [&](int begin, int end) {
    AverageRow row = all;
    for (int y = begin + radius_px_; y < end + radius_px_; ++y) {
      row.values = disparity_px_[y] + radius_px_;
      row.weights = weight_[y] + radius_px_;
      row.means = averaged_px_[y] + radius_px_;
      row.weight_sums = averaged_weight_[y] + radius_px_;
      sweepKernels().average(row);
    }
  });
  std::swap(disparity_px_, averaged_px_);
  std::swap(weight_, averaged_weight_);
}

void SubpixelRefiner::prepare(cv::Size size) {
  const cv::Size padded(size.width + 2 * radius_px_ + kSlack, size.height + 2 * radius_px_);
  if (disparity_px_.size() == padded) return;
  for (cv::Mat1f* plane : {&disparity_px_, &averaged_px_}) {
    plane->create(padded);
    plane->setTo(kNone_px);
  }
  for (cv::Mat1f* plane : {&weight_, &averaged_weight_}) {
    plane->create(padded);
    plane->setTo(0);
  }
}

void SubpixelRefiner::refine(const SubpixelInput& input, const SubpixelParams& params,
                             cv::Mat1f& disparity_px, cv::Mat1f& sigma_px) {
  const cv::Size size = input.rejection->size();
  radius_px_ = params.support_px / 2;
  prepare(size);
  Workers& workers = *input.workers;
  workers.share(size.height, [&](int begin, int end) { fitEach(input, {begin, end}); });
  const float each_way = static_cast<float>(2 * radius_px_ + 1), support = each_way * each_way;
  if (radius_px_ > 0) {
    averageAlong(1, workers);
    averageAlong(disparity_px_.cols, workers);
  }
  disparity_px.create(size);
  sigma_px.create(size);
  workers.share(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* rejections = (*input.rejection)[y];
      const float *means = disparity_px_[y + radius_px_] + radius_px_,
                  *weights = weight_[y + radius_px_] + radius_px_;
      float *disparities = disparity_px[y], *sigmas = sigma_px[y];
      for (int x = 0; x < size.width; ++x) {
        const bool answered = rejections[x] == 0;
        // Neighbours share most of their windows: averaging leaves the variance of one as it was.
        const float variance = support / std::max(weights[x], kLeastWeight) + kModelSigma_px * kModelSigma_px;
        disparities[x] = answered ? means[x] : 0;
        sigmas[x] = answered ? std::sqrt(variance) : 0;
      }
    }
  });
}

}  // namespace cornerstone
