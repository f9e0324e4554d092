// The code of SweepKernels over vectors of the width that the including file is compiled for. It includes
// and instantiates nothing that another file could share: the linker may keep one copy of a shared inline
// function, and it must not be one for a processor that has more.
#pragma once

#include "sweep_paths_impl.h"
#include "sweep_vectors.h"

namespace cornerstone {
namespace {

inline Bytes differences(const std::uint8_t* const* lines, std::ptrdiff_t at, const Bytes* reference) {
  Bytes sum = cv::v_absdiff(cv::vx_load(lines[0] + at), reference[0]);
  for (int c = 1; c < kFeatureChannels; ++c)
    sum = cv::v_add_wrap(sum, cv::v_absdiff(cv::vx_load(lines[c] + at), reference[c]));
  return sum;
}

// True for the lanes of a vector from disparity `first` on that are below `seen`.
inline Bytes seenLanes(const Bytes& steps, int seen, int first) {
  const int left = seen - first;
  return steps < bytesOf(left < 0 ? 0 : left > 255 ? 255 : left);
}

template <int kVectors>
inline void pairCostsOfPixel(const PairCostRow& row, int x, const Bytes& steps, std::uint8_t* costs) {
  Bytes reference[kFeatureChannels];
  for (int c = 0; c < kFeatureChannels; ++c) reference[c] = bytesOf(row.reference[c][x]);
  const SeenLines &one = row.cameras[0], &other = row.cameras[row.camera_count - 1];
  const int seen_by_one = one.seen[x], seen_by_other = other.seen[x];
  const int disparities = kVectors > 0 ? kVectors * kLanes : row.disparities;
  const bool all_seen = seen_by_one >= disparities && seen_by_other >= disparities;
  for (int i = 0; i < disparities; i += kLanes) {
    Bytes a = differences(one.lines, x * one.step + i, reference);
    Bytes b = row.camera_count > 1 ? differences(other.lines, x * other.step + i, reference) : a;
    if (!all_seen) {  // what one camera does not see, the other counts for
      const Bytes in_one = seenLanes(steps, seen_by_one, i), in_other = seenLanes(steps, seen_by_other, i);
      const Bytes chance = bytesOf(row.unseen[x] / 2);
      const Bytes instead_of_one = cv::v_select(in_other, b, chance);
      b = cv::v_select(in_other, b, cv::v_select(in_one, a, chance));
      a = cv::v_select(in_one, a, instead_of_one);
    }
    cv::v_store(costs + i, cv::v_add_wrap(a, b));
  }
}

// Lines that lie across the row are apart in memory: they are asked for some pixels ahead. Those of small
// images stay in the cache.
inline void fetchAhead(const SeenLines& camera, int x, int disparities) {
  constexpr int kAhead = 6, kCacheLine_bytes = 64;
  for (int c = 0; c < kFeatureChannels; ++c)
    for (int i = 0; i < disparities + kCacheLine_bytes - 1; i += kCacheLine_bytes)
      __builtin_prefetch(camera.lines[c] + (x + kAhead) * camera.step + i);
}

template <int kVectors>
void pairCostsOfRow(const PairCostRow& given, std::uint8_t* costs) {
  const PairCostRow row = given;  // no store can change it
  const Bytes steps = countingUp();
  const SeenLines& last = row.cameras[row.camera_count - 1];
  const bool apart = kVectors != 1 && last.step > row.disparities;
  for (int x = 0; x < row.width; ++x) {
    if (apart) fetchAhead(last, x, row.disparities);
    pairCostsOfPixel<kVectors>(row, x, steps, costs + static_cast<std::ptrdiff_t>(x) * row.disparities);
  }
}

void pairCosts(const PairCostRow& row, std::uint8_t* costs) {
  switch (row.disparities / kLanes) {
    case 1:
      return pairCostsOfRow<1>(row, costs);
    case 2:
      return pairCostsOfRow<2>(row, costs);
    case 3:
      return pairCostsOfRow<3>(row, costs);
    default:
      return pairCostsOfRow<0>(row, costs);
  }
}

void slide(std::uint16_t* sums, const std::uint8_t* entering, const std::uint8_t* leaving, int count) {
  for (int i = 0; i < count; i += kHalf) {
    const Words more = cv::v_add_wrap(cv::vx_load(sums + i), cv::vx_load_expand(entering + i));
    cv::v_store(sums + i, cv::v_sub_wrap(more, cv::vx_load_expand(leaving + i)));
  }
}

// The sums of the first column's window, whose columns are entering[-window_px .. -1].
void firstWindow(const WindowRow& row, std::uint16_t* sums) {
  for (int i = 0; i < row.disparities; i += kHalf) {
    Words sum = cv::vx_setzero_u16();
    for (int k = -row.window_px; k < 0; ++k)
      sum = cv::v_add_wrap(sum, cv::vx_load(row.column_sums + row.entering[k] * row.disparities + i));
    cv::v_store(sums + i, sum);
  }
}

inline void slideWindow(const WindowRow& row, int x, std::uint16_t* sums) {
  const std::uint16_t* entering = row.column_sums + row.entering[x] * row.disparities;
  const std::uint16_t* leaving = row.column_sums + row.leaving[x] * row.disparities;
  const std::uint16_t* before = sums - row.disparities;
  for (int i = 0; i < row.disparities; i += kHalf)
    cv::v_store(sums + i, cv::v_sub_wrap(cv::v_add_wrap(cv::vx_load(before + i), cv::vx_load(entering + i)),
                                         cv::vx_load(leaving + i)));
}

void windowCosts(const WindowRow& given, std::uint16_t* sums, std::uint8_t* costs) {
  const WindowRow row = given;  // no store can change it
  const Words scale = cv::vx_setall_u16(static_cast<std::uint16_t>(row.scale));
  for (int x = 0; x < row.width; ++x, sums += row.disparities, costs += row.disparities) {
    x == 0 ? firstWindow(row, sums) : slideWindow(row, x, sums);
    Bytes lowest = bytesOf(255);
    for (int i = 0; i < row.disparities; i += kLanes) {
      const Bytes cost = cv::v_pack(cv::v_mul_hi(cv::vx_load(sums + i), scale),
                                    cv::v_mul_hi(cv::vx_load(sums + i + kHalf), scale));
      lowest = cv::v_min(lowest, cost);
      cv::v_store(costs + i, cost);
    }
    lowest = bytesOf(cv::v_reduce_min(lowest));
    for (int i = 0; i < row.disparities; i += kLanes) cv::v_store(costs + i, cv::vx_load(costs + i) - lowest);
  }
}

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

// A row of less than a vector, in a row of one.
void fitNarrow(const FitRow& row) {
  constexpr int kFloats = cv::v_float32::nlanes;
  short whole_px[kFloats] = {}, before[kFloats] = {}, cost[kFloats] = {}, after[kFloats] = {};
  std::uint8_t rejections[kLanes] = {};
  float fits_px[kFloats], weights[kFloats];
  FitRow wide = row;
  for (int x = 0; x < row.width; ++x) {
    whole_px[x] = row.whole_px[x];
    before[x] = row.before[x];
    cost[x] = row.cost[x];
    after[x] = row.after[x];
    rejections[x] = row.rejections[x];
  }
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

// Neighbours count in pairs of one weight, that of the mean of the two: on a slanted surface the mean would
// else be drawn to the side with the better fits, and those lie where the truth is near a whole pixel.
void average(const AverageRow& row) {
  using Floats = cv::v_float32;
  const Floats largest_step = cv::vx_setall_f32(row.largest_step), least = cv::vx_setall_f32(1e-12F),
               twice = cv::vx_setall_f32(2);
  for (int x = 0; x < row.width; x += Floats::nlanes) {
    const Floats middle = cv::vx_load(row.values + x);
    Floats sum = cv::vx_setzero_f32(), weights = cv::vx_load(row.weights + x), all_weights = weights;
    for (int i = 1; i <= row.radius; ++i) {
      const std::ptrdiff_t step = i * row.step;
      const Floats ahead = cv::vx_load(row.values + x + step) - middle;
      const Floats behind = cv::vx_load(row.values + x - step) - middle;
      const Floats one = cv::vx_load(row.weights + x + step) & (cv::v_abs(ahead) <= largest_step);
      const Floats other = cv::vx_load(row.weights + x - step) & (cv::v_abs(behind) <= largest_step);
      const Floats weight = twice * one * other / cv::v_max(one + other, least);
      sum += weight * (ahead + behind);
      weights += twice * weight;
      all_weights += one + other;
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

void spread(const SpreadRow& row) {
  using Floats = cv::v_float32;
  const Floats largest_step = cv::vx_setall_f32(row.largest_step), one = cv::vx_setall_f32(1);
  const Floats steepest = cv::vx_setall_f32(static_cast<float>(row.reach));  // a disparity a pixel
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
    cv::v_store(row.squares + x, squares / cv::v_max(count, one));
  }
}

inline cv::v_int32 squashed(const cv::v_int32& difference, const cv::v_float32& noise) {
  const cv::v_float32 half = cv::vx_setall_f32(kLargestFeature / 2.F);
  const cv::v_float32 g = cv::v_cvt_f32(difference);
  return cv::v_round(half + half * g / (cv::v_abs(g) + noise));
}

void squash(const SquashRow& row, std::uint8_t* features) {
  const cv::v_float32 noise = cv::vx_setall_f32(row.noise_grey);
  for (int x = 0; x < row.width; x += kHalf) {
    const cv::v_int16 difference = cv::v_reinterpret_as_s16(cv::vx_load_expand(row.ahead + x)) -
                                   cv::v_reinterpret_as_s16(cv::vx_load_expand(row.behind + x));
    cv::v_int32 low, high;
    cv::v_expand(difference, low, high);
    cv::v_pack_u_store(features + x, cv::v_pack(squashed(low, noise), squashed(high, noise)));
  }
}

void smooth(const std::uint8_t* const* rows, int width, std::uint8_t* out) {
  const auto across = [&](int x) {
    const Words middle = cv::vx_load_expand(rows[1] + x);
    return cv::vx_load_expand(rows[0] + x) + middle + middle + cv::vx_load_expand(rows[2] + x);
  };
  for (int x = 0; x < width; x += kHalf) {
    const Words middle = across(x);
    cv::v_rshr_pack_store<4>(out + x, across(x - 1) + middle + middle + across(x + 1));
  }
}

}  // namespace
}  // namespace cornerstone
