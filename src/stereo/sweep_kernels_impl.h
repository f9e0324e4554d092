// The code of SweepKernels over vectors of the width that the including file is compiled for. It includes
// and instantiates nothing that another file could share: the linker may keep one copy of a shared inline
// function, and it must not be one for a processor that has more.
#pragma once

#include "answer_kernels_impl.h"
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
  withVectorsOf(row.disparities, [&](auto vectors) { pairCostsOfRow<vectors.kCount>(row, costs); });
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

inline void costsOfWindow(const std::uint16_t* sums, int disparities, const Words& scale,
                          std::uint8_t* costs) {
  Bytes lowest = bytesOf(255);
  for (int i = 0; i < disparities; i += kLanes) {
    const Bytes cost = cv::v_pack(cv::v_mul_hi(cv::vx_load(sums + i), scale),
                                  cv::v_mul_hi(cv::vx_load(sums + i + kHalf), scale));
    lowest = cv::v_min(lowest, cost);
    cv::v_store(costs + i, cost);
  }
  lowest = lowestEverywhere(lowest);
  for (int i = 0; i < disparities; i += kLanes) cv::v_store(costs + i, cv::vx_load(costs + i) - lowest);
}

template <int kVectors>
void windowCostsOfRow(const WindowRow& given, std::uint16_t* sums, std::uint8_t* costs) {
  WindowRow row = given;  // no store can change it
  if (kVectors > 0) row.disparities = kVectors * kLanes;
  const Words scale = cv::vx_setall_u16(static_cast<std::uint16_t>(row.scale));
  firstWindow(row, sums);
  costsOfWindow(sums, row.disparities, scale, costs);
  for (int x = 1; x < row.width; ++x) {
    sums += row.disparities;
    costs += row.disparities;
    slideWindow(row, x, sums);
    costsOfWindow(sums, row.disparities, scale, costs);
  }
}

void windowCosts(const WindowRow& row, std::uint16_t* sums, std::uint8_t* costs) {
  withVectorsOf(row.disparities, [&](auto vectors) { windowCostsOfRow<vectors.kCount>(row, sums, costs); });
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
