// The code of SweepKernels over vectors of the width that the including file is compiled for. It includes
// and instantiates nothing that another file could share: the linker may keep one copy of a shared inline
// function, and it must not be one for a processor that has more.
#pragma once

#include <opencv2/core/hal/intrin.hpp>

#include "cornerstone/stereo/sweep_kernels.h"

namespace cornerstone {
namespace {

using Bytes = cv::v_uint8;
using Words = cv::v_uint16;
constexpr int kLanes = Bytes::nlanes;
constexpr int kHalf = Words::nlanes;

inline Bytes bytesOf(int value) { return cv::vx_setall_u8(static_cast<std::uint8_t>(value)); }

inline Bytes differences(const std::uint8_t* const* lines, std::ptrdiff_t at, const Bytes* reference) {
  Bytes sum = cv::v_absdiff(cv::vx_load(lines[0] + at), reference[0]);
  for (int c = 1; c < kFeatureChannels; ++c)
    sum = cv::v_add_wrap(sum, cv::v_absdiff(cv::vx_load(lines[c] + at), reference[c]));
  return sum;
}

inline Bytes countingUp() {
  std::uint8_t steps[kLanes];
  for (int i = 0; i < kLanes; ++i) steps[i] = static_cast<std::uint8_t>(i);
  return cv::vx_load(steps);
}

// True for the lanes of a vector from disparity `first` on that are below `seen`.
inline Bytes seenLanes(const Bytes& steps, int seen, int first) {
  const int left = seen - first;
  return steps < bytesOf(left < 0 ? 0 : left > 255 ? 255 : left);
}

inline void pairCostsOfPixel(const PairCostRow& row, int x, const Bytes& steps, std::uint8_t* costs) {
  Bytes reference[kFeatureChannels];
  for (int c = 0; c < kFeatureChannels; ++c) reference[c] = bytesOf(row.reference[c][x]);
  const SeenLines &one = row.cameras[0], &other = row.cameras[row.camera_count - 1];
  const int seen_by_one = one.seen[x], seen_by_other = other.seen[x];
  const bool all_seen = seen_by_one >= row.disparities && seen_by_other >= row.disparities;
  for (int i = 0; i < row.disparities; i += kLanes) {
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

void pairCosts(const PairCostRow& row, std::uint8_t* costs) {
  const Bytes steps = countingUp();
  for (int x = 0; x < row.width; ++x)
    pairCostsOfPixel(row, x, steps, costs + static_cast<std::ptrdiff_t>(x) * row.disparities);
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

void windowCosts(const WindowRow& row, std::uint16_t* sums, std::uint8_t* costs) {
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

// One pixel of a path (Hirschmueller, 2008, equation 13), with p the path costs of the pixel before:
//   L(i) = C(i) + min(p(i), p(i - 1) + P1, p(i + 1) + P1, min p + P2) - min p
class PathStep {
 public:
  PathStep(int lowest_before, int jump_penalty, const Bytes& slope_penalty)
      : lowest_before_(bytesOf(lowest_before)),
        limit_(bytesOf(lowest_before) + bytesOf(jump_penalty)),
        slope_penalty_(slope_penalty) {}
  Bytes operator()(const Bytes& below, const Bytes& here, const Bytes& above, const Bytes& cost) const {
    const Bytes beside = cv::v_min(below, above) + slope_penalty_;
    return cost + (cv::v_min(cv::v_min(here, beside), limit_) - lowest_before_);
  }

 private:
  Bytes lowest_before_, limit_, slope_penalty_;
};

// One path through a row; `here` are the path costs of the pixel reached.
class Path {
 public:
  Path(const PathRow& row, int first, std::uint8_t* here)
      : row_(row), slope_penalty_(bytesOf(row.slope_penalty)), here_(here) {
    // Nothing before the first pixel: its own costs.
    lowest_ = take(PathStep(0, 0, slope_penalty_), first, here);
  }
  // On to a neighbouring column, whose costs are to be written `by` further.
  void go(int column, int jump_penalty, std::ptrdiff_t by) {
    lowest_ = take(PathStep(lowest_, jump_penalty, slope_penalty_), column, here_ + by);
    here_ += by;
  }

 private:
  int take(const PathStep& step, int column, std::uint8_t* out) const {
    const std::uint8_t* costs = row_.costs + static_cast<std::ptrdiff_t>(column) * row_.disparities;
    Bytes lowest = bytesOf(255);
    for (int i = 0; i < row_.disparities; i += kLanes) {
      const Bytes sum = step(cv::vx_load(here_ + i - 1), cv::vx_load(here_ + i), cv::vx_load(here_ + i + 1),
                             cv::vx_load(costs + i));
      cv::v_store(out + i, sum);
      lowest = cv::v_min(lowest, sum);
    }
    out[-1] = out[row_.disparities] = 255;
    return cv::v_reduce_min(lowest);
  }

  const PathRow& row_;
  Bytes slope_penalty_;
  std::uint8_t* here_;
  int lowest_ = 0;
};

// Both paths together: each waits for its own last pixel.
void pathsAlong(const PathRow& row) {
  const int last = row.width - 1;
  const std::ptrdiff_t stride = row.disparities + 2;
  Path left(row, 0, row.from_left + 1), right(row, last, row.from_right + 1 + last * stride);
  for (int x = 1; x < row.width; ++x) {
    const int mirror = last - x;
    left.go(x, row.jump_ahead[x], stride);
    right.go(mirror, row.jump_ahead[mirror + 1], -stride);
  }
}

inline int indexOf(int value, const std::uint8_t* values) {
  const Bytes wanted = bytesOf(value);
  int i = 0;
  Bytes found = cv::vx_load(values) == wanted;
  while (!cv::v_check_any(found)) found = cv::vx_load(values + (i += kLanes)) == wanted;
  return i + cv::v_scan_forward(found);
}

// `steps` count up from 2; `lowest` is among the sums.
inline PathWinner winnerOf(const PathRow& row, const std::uint8_t* costs, int lowest, const Bytes& steps) {
  const int index = indexOf(lowest, row.sums);
  const Bytes one = bytesOf(1);
  Bytes second = bytesOf(255), rival = second;
  for (int i = 0; i < row.disparities; i += kLanes) {
    const int ahead = index - i;  // lanes within one of it do not count
    Bytes sum = cv::vx_load(row.sums + i), cost = cv::vx_load(costs + i);
    if (ahead >= -1 && ahead <= kLanes) {
      const Bytes beside = cv::v_absdiff(steps, bytesOf(ahead + 2)) <= one;
      sum = sum | beside;
      cost = cost | beside;
    }
    second = cv::v_min(second, sum);
    rival = cv::v_min(rival, cost);
  }
  const int margin = cv::v_reduce_min(second) - lowest, lead = cv::v_reduce_min(rival) - costs[index];
  return {static_cast<short>(index), static_cast<std::uint8_t>(margin),
          static_cast<std::uint8_t>(lead > 0 ? lead : 0)};
}

void pathDown(const PathRow& row) {
  const int n = row.disparities;
  const std::ptrdiff_t stride = n + 2;
  const Bytes slope_penalty = bytesOf(row.slope_penalty), steps = countingUp() + bytesOf(2);
  const std::uint8_t *costs = row.costs, *left = row.from_left + 1, *right = row.from_right + 1;
  std::uint8_t* down = row.from_above + 1;
  for (int x = 0; x < row.width; ++x, costs += n, left += stride, right += stride, down += stride) {
    const PathStep step(row.lowest_above[x], row.jump_down[x], slope_penalty);
    Bytes lowest = bytesOf(255), lowest_sum = lowest, below = cv::vx_load(down - 1);
    for (int i = 0; i < n; i += kLanes) {
      const Bytes next_below = cv::vx_load(down + i + kLanes - 1);  // before it is overwritten
      const Bytes path =
          step(below, cv::vx_load(down + i), cv::vx_load(down + i + 1), cv::vx_load(costs + i));
      below = next_below;
      cv::v_store(down + i, path);
      lowest = cv::v_min(lowest, path);
      const Bytes sum = path + cv::vx_load(left + i) + cv::vx_load(right + i);
      cv::v_store(row.sums + i, sum);
      lowest_sum = cv::v_min(lowest_sum, sum);
    }
    row.lowest_above[x] = static_cast<std::uint8_t>(cv::v_reduce_min(lowest));
    row.winners[x] = winnerOf(row, costs, cv::v_reduce_min(lowest_sum), steps);
  }
}

void average(const AverageRow& row) {
  using Floats = cv::v_float32;
  const Floats largest_step = cv::vx_setall_f32(row.largest_step), least = cv::vx_setall_f32(1e-12F);
  for (int x = 0; x < row.width; x += Floats::nlanes) {
    const Floats middle = cv::vx_load(row.values + x);
    Floats sum = cv::vx_setzero_f32(), weights = cv::vx_setzero_f32();
    for (int i = -row.radius; i <= row.radius; ++i) {
      const Floats ahead = cv::vx_load(row.values + x + i * row.step) - middle;
      const Floats weight = cv::vx_load(row.weights + x + i * row.step) & (cv::v_abs(ahead) <= largest_step);
      sum += weight * ahead;
      weights += weight;
    }
    cv::v_store(row.means + x, middle + sum / cv::v_max(weights, least));
    cv::v_store(row.weight_sums + x, weights);
  }
}

}  // namespace
}  // namespace cornerstone
