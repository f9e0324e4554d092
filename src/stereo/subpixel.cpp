#include "cornerstone/stereo/subpixel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cornerstone/stereo/cost_noise.h"
#include "cornerstone/stereo/sweep_kernels.h"

namespace cornerstone {
namespace {

constexpr int kSlack = 16;  // kernels work in whole vectors
constexpr float kNone_px = -1e4F;
constexpr float kLargestStep_px = 1.0F;

// sigma^2 = spread^2 + (kNoiseShare noise)^2 + kModelSigma^2. The spread says what no model of the noise
// does: what is left at depth edges, on steep or curved surfaces and where textures repeat. Half of it: 0.50
// to 0.65 of the errors are within one sigma, double: 0.75 to 0.90. Neighbours share most of their windows,
// so that their average is little better than one of them. Half: 0.52 to 0.70 of the errors within one sigma;
// double: 0.70 to 0.90.
constexpr float kNoiseShare = 0.75F;
// Rounding and what neighbours have in common: 0.68 of the errors on a light field, which has no faults of
// rectification, are within one sigma with half of it, 0.87 with double.
constexpr float kModelSigma_px = 0.05F;

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
    row.fits_px = fits_.rowOf(fits_.values_px, y);
    row.weights = fits_.rowOf(fits_.weights, y);
    sweepKernels().fit(row);
  }
}

// Weighted mean of the pixels at -radius .. radius steps that are at most kLargestStep_px from the middle
// one. `step` in floats.
void SubpixelRefiner::averageRow(int y, std::ptrdiff_t step, const Planes& from, Planes& to) const {
  AverageRow row;
  row.step = step;
  row.radius = radius_px_;
  row.width = from.width();
  row.largest_step = kLargestStep_px;
  row.values = from.rowOf(from.values_px, y);
  row.weights = from.rowOf(from.weights, y);
  row.means = to.rowOf(to.values_px, y);
  row.weight_sums = to.rowOf(to.weights, y);
  sweepKernels().average(row);
}

// The sigmas take the place of the averages along lines, which nobody needs any more.
void SubpixelRefiner::sigmaRow(int y, int reach_px) {
  const auto each_way = static_cast<float>(2 * radius_px_ + 1);
  SigmaRow row;
  row.fits = fits_.rowOf(fits_.values_px, y);
  row.means = means_.rowOf(means_.values_px, y);
  row.step = fits_.values_px.cols;
  row.reach = reach_px;
  row.width = fits_.width();
  row.largest_step = kLargestStep_px;
  row.weights = means_.rowOf(means_.weights, y);
  row.noise_variance = kNoiseShare * kNoiseShare * each_way * each_way;
  row.model_variance = kModelSigma_px * kModelSigma_px;
  row.sigmas = lines_.rowOf(lines_.values_px, y);
  sweepKernels().sigma(row);
}

void SubpixelRefiner::Planes::prepare(cv::Size size, int border) {
  const cv::Size padded(size.width + 2 * border + kSlack, size.height + 2 * border);
  if (values_px.size() == padded && border_px == border) return;
  border_px = border;
  values_px.create(padded);
  values_px.setTo(kNone_px);
  weights.create(padded);
  weights.setTo(0);
}

int SubpixelRefiner::Planes::width() const { return values_px.cols - 2 * border_px - kSlack; }

void SubpixelRefiner::refine(const SubpixelInput& input, const SubpixelParams& params,
                             cv::Mat1f& disparity_px, cv::Mat1f& sigma_px) {
  const cv::Size size = input.rejection->size();
  const int reach_px = input.window_px / 2;
  radius_px_ = params.support_px / 2;
  for (Planes* planes : {&fits_, &lines_, &means_}) planes->prepare(size, std::max(radius_px_, reach_px));
  disparity_px.create(size);
  sigma_px.create(size);
  Workers& workers = *input.workers;
  workers.share(size.height, [&](int begin, int end) {
    fitEach(input, {begin, end});
    for (int y = begin; y < end; ++y) averageRow(y, 1, fits_, lines_);
  });
  workers.share(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) averageRow(y, lines_.values_px.cols, lines_, means_);
  });
  workers.share(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      sigmaRow(y, reach_px);
      writeRow(y, (*input.rejection)[y], disparity_px[y], sigma_px[y]);
    }
  });
}

void SubpixelRefiner::writeRow(int y, const std::uint8_t* rejections, float* disparities_px,
                               float* sigmas_px) const {
  const float *means = means_.rowOf(means_.values_px, y), *sigmas = lines_.rowOf(lines_.values_px, y);
  const int width = means_.width();
  for (int x = 0; x < width; ++x) {
    const float mean_px = means[x], sigma_px = sigmas[x];  // read always, so that vectors can be
    disparities_px[x] = rejections[x] == 0 ? mean_px : 0;
    sigmas_px[x] = rejections[x] == 0 ? sigma_px : 0;
  }
}

}  // namespace cornerstone
