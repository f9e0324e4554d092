// The kernels of SweepKernels that make answers of winners, see sweep_kernels_impl.h: verdicts, sub-pixel
// fits, their averages and standard deviations.
#pragma once

#include "sweep_vectors.h"

namespace cornerstone {
namespace {

inline cv::v_float32 floatsOf(const short* values) { return cv::v_cvt_f32(cv::vx_load_expand(values)); }

inline void fitVector(const FitRow& row, int x) {
  using Floats = cv::v_float32;
  const Floats half = cv::vx_setall_f32(0.5F), zero = cv::vx_setzero_f32();
  const Floats cost = floatsOf(row.cost + x);
  const Floats fall = floatsOf(row.before + x) - cost, rise = floatsOf(row.after + x) - cost;
  const Floats step = cv::v_max(cv::v_max(fall, rise), cv::vx_setall_f32(1));
  const Floats twice = step + step;
  const Floats ahead = cv::v_min(cv::v_max((fall - rise) / twice, zero - half), half);
  const Floats root_weight =
      twice / (cv::vx_setall_f32(row.noise_share) * (cost + cv::vx_setall_f32(row.least_cost)));
  const cv::v_int32 rejection = cv::v_reinterpret_as_s32(cv::vx_load_expand_q(row.rejections + x));
  const Floats answered = cv::v_reinterpret_as_f32(rejection == cv::vx_setzero_s32());
  const Floats fit = floatsOf(row.whole_px + x) + ahead;
  cv::v_store(row.fits_px + x, cv::v_select(answered, fit, cv::vx_setall_f32(row.none_px)));
  cv::v_store(row.weights + x, root_weight * root_weight & answered);
}

// What a row of less than a vector holds, and zeros up to a whole one.
template <typename T>
class Widened {
 public:
  Widened(const T* from, int width) {
    for (int x = 0; x < width; ++x) values_[x] = from[x];
  }
  operator const T*() const { return values_; }

 private:
  T values_[kLanes] = {};
};

void fitNarrow(const FitRow& row) {
  const Widened<short> whole_px(row.whole_px, row.width), before(row.before, row.width),
      cost(row.cost, row.width), after(row.after, row.width);
  const Widened<std::uint8_t> rejections(row.rejections, row.width);
  float fits_px[kLanes] = {}, weights[kLanes] = {};
  FitRow wide = row;
  wide.whole_px = whole_px;
  wide.before = before;
  wide.cost = cost;
  wide.after = after;
  wide.rejections = rejections;
  wide.fits_px = fits_px;
  wide.weights = weights;
  fitVector(wide, 0);
  for (int x = 0; x < row.width; ++x) {
    row.fits_px[x] = fits_px[x];
    row.weights[x] = weights[x];
  }
}

void fit(const FitRow& row) {
  constexpr int kFloats = cv::v_float32::nlanes;
  if (row.width < kFloats) return fitNarrow(row);
  for (int x = 0; x < row.width - kFloats; x += kFloats) fitVector(row, x);
  fitVector(row, row.width - kFloats);
}

// Neighbours on opposite sides count alike, with the weight of the mean of the two: on a slanted surface the
// mean would else be drawn to the side with the better fits, and those lie where the truth is near a whole
// pixel. At a surface's edge the neighbours that there are count alone.
void average(const AverageRow& row) {
  using Floats = cv::v_float32;
  const Floats largest_step = cv::vx_setall_f32(row.largest_step), least = cv::vx_setall_f32(1e-12F),
               twice = cv::vx_setall_f32(2), none = cv::vx_setzero_f32();
  for (int x = 0; x < row.width; x += Floats::nlanes) {
    const Floats middle = cv::vx_load(row.values + x);
    Floats sum = none, weights = cv::vx_load(row.weights + x), all_weights = weights;
    for (int i = 1; i <= row.radius; ++i) {
      const std::ptrdiff_t step = i * row.step;
      const Floats ahead = cv::vx_load(row.values + x + step) - middle;
      const Floats behind = cv::vx_load(row.values + x - step) - middle;
      const Floats one = cv::vx_load(row.weights + x + step) & (cv::v_abs(ahead) <= largest_step);
      const Floats other = cv::vx_load(row.weights + x - step) & (cv::v_abs(behind) <= largest_step);
      const Floats both = one + other, alike = twice * one * other / cv::v_max(both, least);
      const Floats alone = alike <= none;
      const Floats weight = cv::v_select(alone, one, alike),
                   weight_behind = cv::v_select(alone, other, alike);
      sum += weight * ahead + weight_behind * behind;
      weights += weight + weight_behind;
      all_weights += both;
    }
    cv::v_store(row.means + x, middle + sum / cv::v_max(weights, least));
    cv::v_store(row.weight_sums + x, all_weights);
  }
}

// Half the rise of the means from `before` to `after`; 0 where one of them is on another surface.
inline cv::v_float32 riseAt(const float* before, const float* after, const cv::v_float32& middle,
                            const cv::v_float32& largest) {
  const cv::v_float32 low = cv::vx_load(before), high = cv::vx_load(after);
  const cv::v_float32 same = (cv::v_abs(low - middle) <= largest) & (cv::v_abs(high - middle) <= largest);
  return (cv::vx_setall_f32(0.5F) * (high - low)) & same;
}

void sigma(const SigmaRow& row) {
  using Floats = cv::v_float32;
  const Floats largest_step = cv::vx_setall_f32(row.largest_step), one = cv::vx_setall_f32(1);
  const Floats steepest = cv::vx_setall_f32(static_cast<float>(row.reach));  // a disparity a pixel
  const Floats noise_variance = cv::vx_setall_f32(row.noise_variance),
               model_variance = cv::vx_setall_f32(row.model_variance),
               least_weight = cv::vx_setall_f32(1e-6F);
  const std::ptrdiff_t down = row.reach * row.step;
  for (int x = 0; x < row.width; x += Floats::nlanes) {
    const float* means = row.means + x;
    const Floats middle = cv::vx_load(means);
    const Floats right = riseAt(means - row.reach, means + row.reach, middle, steepest);
    Floats plane = middle - riseAt(means - down, means + down, middle, steepest);
    const Floats rise_down = middle - plane;
    Floats squares = cv::vx_setzero_f32(), count = squares;
    for (int i = -1; i <= 1; ++i, plane += rise_down) {
      const float* fits = row.fits + x + i * down;
      for (const Floats& ahead : {cv::vx_load(fits - row.reach) - (plane - right), cv::vx_load(fits) - plane,
                                  cv::vx_load(fits + row.reach) - (plane + right)}) {
        const Floats near = cv::v_abs(ahead) <= largest_step;
        squares += ahead * ahead & near;
        count += one & near;
      }
    }
    const Floats noise = noise_variance / cv::v_max(cv::vx_load(row.weights + x), least_weight);
    cv::v_store(row.sigmas + x, cv::v_sqrt(noise + squares / cv::v_max(count, one) + model_variance));
  }
}

using Shorts = cv::v_int16;

inline Shorts shortsOf(int value) { return cv::vx_setall_s16(static_cast<short>(value)); }

// one > factor * other + offset of factor, in floats.
inline Shorts exceeds(const Shorts& one, float factor, const Shorts& other, int offset) {
  const cv::v_float32 times = cv::vx_setall_f32(factor);
  const cv::v_int32 more = cv::vx_setall_s32(offset);
  cv::v_uint32 low, high;
  cv::v_int32 other_low, other_high;
  cv::v_expand(cv::v_reinterpret_as_u16(one), low, high);
  cv::v_expand(other, other_low, other_high);
  const auto above = [&](const cv::v_uint32& a, const cv::v_int32& b) {
    return cv::v_reinterpret_as_s32(cv::v_cvt_f32(cv::v_reinterpret_as_s32(a)) >
                                    times * cv::v_cvt_f32(b + more));
  };
  return cv::v_pack(above(low, other_low), above(high, other_high));
}

inline void judgeVector(const WinnerRow& row, int x, std::uint8_t* verdicts, std::uint8_t* evidence) {
  const Shorts disparity_px = cv::vx_load(row.disparities_px + x), cost = cv::vx_load(row.costs + x),
               chance = cv::vx_load(row.chance + x);
  const Words margin = cv::vx_load_expand(row.margins + x);
  const Shorts last_px = shortsOf(row.last_px);
  const Shorts outward = ((disparity_px < shortsOf(2)) & (cv::vx_load(row.before + x) < cost)) |
                         ((disparity_px >= last_px) & (cv::vx_load(row.after + x) < cost)) |
                         (disparity_px > last_px);
  const Shorts gain = cv::v_max(chance - cost, shortsOf(0));
  const Shorts flat = ~exceeds(gain, row.flat_gain, chance, 0);
  const Words product = cv::v_mul_wrap(margin, cv::vx_load_expand(row.leads + x));
  const Shorts strong = exceeds(cv::v_reinterpret_as_s16(product), row.strong_product, cost, row.least_cost);
  const Shorts unclear = cv::v_select(flat, shortsOf(row.texture), shortsOf(row.uniqueness));
  const Shorts within = cv::v_select(outward, shortsOf(row.range), shortsOf(row.none));
  const Shorts narrow = cv::v_reinterpret_as_s16(margin) < shortsOf(row.smallest_margin);
  const Shorts verdict = cv::v_select(cost == shortsOf(row.no_cost), shortsOf(row.outside),
                                      cv::v_select(narrow, unclear, within));
  cv::v_pack_u_store(verdicts + x, verdict);
  const Shorts not_strong = cv::v_select(flat, shortsOf(row.flat), shortsOf(row.weak));
  cv::v_pack_u_store(evidence + x, cv::v_select(strong, shortsOf(row.strong), not_strong));
}

void judgeNarrow(const WinnerRow& row, std::uint8_t* verdicts, std::uint8_t* evidence) {
  const Widened<short> disparities_px(row.disparities_px, row.width), costs(row.costs, row.width),
      before(row.before, row.width), after(row.after, row.width), chance(row.chance, row.width);
  const Widened<std::uint8_t> margins(row.margins, row.width), leads(row.leads, row.width);
  std::uint8_t wide_verdicts[kLanes] = {}, wide_evidence[kLanes] = {};
  WinnerRow wide = row;
  wide.disparities_px = disparities_px;
  wide.costs = costs;
  wide.before = before;
  wide.after = after;
  wide.chance = chance;
  wide.margins = margins;
  wide.leads = leads;
  judgeVector(wide, 0, wide_verdicts, wide_evidence);
  for (int x = 0; x < row.width; ++x) {
    verdicts[x] = wide_verdicts[x];
    evidence[x] = wide_evidence[x];
  }
}

void judge(const WinnerRow& given, std::uint8_t* verdicts, std::uint8_t* evidence) {
  const WinnerRow row = given;  // no store can change it
  if (row.width < kHalf) return judgeNarrow(row, verdicts, evidence);
  for (int x = 0; x < row.width - kHalf; x += kHalf) judgeVector(row, x, verdicts, evidence);
  judgeVector(row, row.width - kHalf, verdicts, evidence);
}

}  // namespace
}  // namespace cornerstone
