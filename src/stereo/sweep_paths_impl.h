// The path kernels of SweepKernels, see sweep_kernels_impl.h. `kVectors`: how many vectors a pixel's costs
// fill, 0: any number. Few are kept in registers, where neighbouring disparities are had by turning them;
// what has just been stored is slow to load again from one byte aside.
#pragma once

#include "sweep_vectors.h"

namespace cornerstone {
namespace {

// One pixel of a path (Hirschmueller, 2008, equation 13), with p the path costs of the pixel before:
//   L(i) = C(i) + min(p(i), p(i - 1) + P1, p(i + 1) + P1, min p + P2) - min p
class PathStep {
 public:
  PathStep(const Bytes& lowest_before, int jump_penalty, const Bytes& slope_penalty)
      : lowest_before_(lowest_before),
        limit_(lowest_before + bytesOf(jump_penalty)),
        slope_penalty_(slope_penalty) {}
  Bytes operator()(const Bytes& below, const Bytes& here, const Bytes& above, const Bytes& cost) const {
    const Bytes beside = cv::v_min(below, above) + slope_penalty_;
    return cost + (cv::v_min(cv::v_min(here, beside), limit_) - lowest_before_);
  }

 private:
  Bytes lowest_before_, limit_, slope_penalty_;
};

// One path through a row of any number of disparities; `here` are the path costs of the pixel reached.
template <int kVectors>
class Path {
 public:
  Path(const PathRow& row, int first, std::uint8_t* here)
      : row_(row), slope_penalty_(bytesOf(row.slope_penalty)), here_(here) {
    for (Bytes& few : few_) few = bytesOf(0);
    // Nothing before the first pixel: its own costs.
    lowest_ = take(PathStep(bytesOf(0), 0, slope_penalty_), first, here);
  }
  // On to a neighbouring column, whose costs are to be written `by` further.
  void go(int column, int jump_penalty, std::ptrdiff_t by) {
    lowest_ = take(PathStep(lowest_, jump_penalty, slope_penalty_), column, here_ + by);
    here_ += by;
  }

 private:
  Bytes take(const PathStep& step, int column, std::uint8_t* out) {
    if constexpr (kVectors > 0) return takeFew(step, column, out);
    const std::uint8_t* costs = row_.costs + static_cast<std::ptrdiff_t>(column) * row_.disparities;
    Bytes lowest = bytesOf(255);
    for (int i = 0; i < row_.disparities; i += kLanes) {
      const Bytes sum = step(cv::vx_load(here_ + i - 1), cv::vx_load(here_ + i), cv::vx_load(here_ + i + 1),
                             cv::vx_load(costs + i));
      cv::v_store(out + i, sum);
      lowest = cv::v_min(lowest, sum);
    }
    out[-1] = out[row_.disparities] = 255;
    return lowestEverywhere(lowest);
  }
  Bytes takeFew(const PathStep& step, int column, std::uint8_t* out) {
    const std::uint8_t* costs = row_.costs + static_cast<std::ptrdiff_t>(column) * kVectors * kLanes;
    const Bytes none = bytesOf(255);
    Bytes lowest = none, last = none;
    for (int k = 0; k < kVectors; ++k) {
      const Bytes here = few_[k], next = k + 1 < kVectors ? few_[k + 1] : none;
      few_[k] = step(cv::v_rotate_left<1>(here, last), here, cv::v_rotate_right<1>(here, next),
                     cv::vx_load(costs + k * kLanes));
      last = here;
      cv::v_store(out + k * kLanes, few_[k]);
      lowest = cv::v_min(lowest, few_[k]);
    }
    return lowestEverywhere(lowest);
  }

  const PathRow& row_;
  const Bytes slope_penalty_;
  std::uint8_t* here_;
  Bytes few_[kVectors > 0 ? kVectors : 1];  // the same as here_, if few
  Bytes lowest_;
};

// Both paths together: each waits for its own last pixel.
template <int kVectors>
void pathsThrough(const PathRow& given) {
  const PathRow row = given;  // no store can change it
  const int last = row.width - 1;
  const std::ptrdiff_t stride = row.disparities + 2;
  Path<kVectors> left(row, 0, row.from_left + 1), right(row, last, row.from_right + 1 + last * stride);
  for (int x = 1; x < row.width; ++x) {
    const int mirror = last - x;
    left.go(x, row.jump_ahead[x], stride);
    right.go(mirror, row.jump_ahead[mirror + 1], -stride);
  }
}

void pathsAlong(const PathRow& row) {
  withVectorsOf(row.disparities, [&](auto vectors) { pathsThrough<vectors.kCount>(row); });
}

inline int indexOf(const Bytes& wanted, const std::uint8_t* values) {
  int i = 0;
  Bytes found = cv::vx_load(values) == wanted;
  while (!cv::v_check_any(found)) found = cv::vx_load(values + (i += kLanes)) == wanted;
  return i + cv::v_scan_forward(found);
}

struct PathWinner {
  int index, margin, lead;
};

// `steps` count up from 2; `lowest`, in every lane, is among the sums.
inline PathWinner winnerOf(const PathRow& row, const std::uint8_t* costs, const Bytes& lowest,
                           const Bytes& steps) {
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
  const int lead = lowestOf(rival) - costs[index];
  return {index, lowestOf(second) - row.sums[index], lead > 0 ? lead : 0};
}

template <int kVectors>
void pathOneDown(const PathRow& given) {
  PathRow row = given;  // no store can change it
  if (kVectors > 0) row.disparities = kVectors * kLanes;
  const int n = row.disparities;
  const std::ptrdiff_t stride = n + 2;
  const Bytes slope_penalty = bytesOf(row.slope_penalty), steps = countingUp() + bytesOf(2);
  const std::uint8_t *costs = row.costs, *left = row.from_left + 1, *right = row.from_right + 1;
  std::uint8_t* down = row.from_above + 1;
  for (int x = 0; x < row.width; ++x, costs += n, left += stride, right += stride, down += stride) {
    const PathStep step(bytesOf(row.lowest_above[x]), row.jump_down[x], slope_penalty);
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
    row.lowest_above[x] = static_cast<std::uint8_t>(lowestOf(lowest));
    const PathWinner winner = winnerOf(row, costs, lowestEverywhere(lowest_sum), steps);
    row.winners.disparities_px[x] = static_cast<short>(winner.index + 1);
    row.winners.margins[x] = static_cast<std::uint8_t>(winner.margin);
    row.winners.leads[x] = static_cast<std::uint8_t>(winner.lead);
  }
}

void pathDown(const PathRow& row) {
  withVectorsOf(row.disparities, [&](auto vectors) { pathOneDown<vectors.kCount>(row); });
}

}  // namespace
}  // namespace cornerstone
