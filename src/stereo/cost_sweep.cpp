#include "cornerstone/stereo/cost_sweep.h"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>

#include "cornerstone/stereo/pair_cost.h"

namespace cornerstone {
namespace {

constexpr int kLanes = 8;
constexpr int kCoarseSteps = 2;  // fine windows beside the middle one that the widest sum reaches
// Rows of a band are chosen so that what the sweep touches stays in the second-level cache.
constexpr int kBandPixels = 24 * 1024;
constexpr int kSmallestBand_rows = 32;

// The row or column that a border one mirrors: -1 -> 0, count -> count - 1.
int mirrored(int at, int count) {
  while (at < 0 || at >= count) at = at < 0 ? -1 - at : 2 * count - 1 - at;
  return at;
}

template <typename T>
void mirrorEnds(T* row, int border, int width) {  // row[border] is the image's first column
  for (int i = 0; i < border; ++i) {
    row[i] = row[border + mirrored(i - border, width)];
    row[border + width + i] = row[border + mirrored(width + i, width)];
  }
}

// Buffers are wide enough for whole vectors at the right end.
int roundUp(int count) { return (count + kLanes - 1) / kLanes * kLanes; }

// sums[x] = costs[x] + .. + costs[x + window - 1]: at most 7 * 16, so bytes do.
void sumAlongRow(const std::uint8_t* costs, int window, std::uint8_t* sums, int width) {
  for (int x = 0; x < width; x += 2 * kLanes) {
    cv::v_uint8x16 sum = cv::v_load(costs + x);
    for (int i = 1; i < window; ++i) sum = cv::v_add_wrap(sum, cv::v_load(costs + x + i));
    cv::v_store(sums + x, sum);
  }
}

void addRow(const std::uint8_t* entering, std::uint16_t* sums, int width) {
  for (int x = 0; x < width; x += kLanes)
    cv::v_store(sums + x, cv::v_add_wrap(cv::v_load(sums + x), cv::v_load_expand(entering + x)));
}

// next = sums + entering - leaving
void slideRow(const std::uint16_t* sums, const std::uint8_t* entering, const std::uint8_t* leaving,
              std::uint16_t* next, int width) {
  for (int x = 0; x < width; x += kLanes) {
    const cv::v_uint16x8 more = cv::v_add_wrap(cv::v_load(sums + x), cv::v_load_expand(entering + x));
    cv::v_store(next + x, cv::v_sub_wrap(more, cv::v_load_expand(leaving + x)));
  }
}

}  // namespace

SecondaryView::SecondaryView(const cv::Mat1b& census, const cv::Point2d& shift)
    : census_(&census),
      shift_fixed_(cv::Point2d(shift.x * (1 << kFractionBits), shift.y * (1 << kFractionBits))) {}

void CostSweep::prepare(const SweepInput& input) {
  input_ = input;
  size_px_ = input.reference_census->size();
  radius_px_ = input.window_px / 2;
  const int width = roundUp(size_px_.width), rows = size_px_.height;
  const int bordered = width + 2 * kCoarseSteps * input.window_px + 2 * kLanes;
  pair_costs_.create(1, bordered);
  row_sums_.create(rows, bordered);
  fine_sums_.create(rows, bordered);
  inner_.create(1, bordered);
  outer_.create(1, bordered);
  for (cv::Mat1s& costs : costs_) costs.create(rows, width);
  for (cv::Mat1s* plane : {&winners_.disparity_px, &winners_.cost, &winners_.cost_before,
                           &winners_.cost_after, &winners_.second_cost})
    plane->create(rows, width);
}

const Winners& CostSweep::run(const SweepInput& input) {
  prepare(input);
  winners_.cost.setTo(Winners::kNoCost);
  winners_.second_cost.setTo(Winners::kNoCost);
  winners_.cost_before.setTo(Winners::kNoCost);
  winners_.cost_after.setTo(Winners::kNoCost);
  winners_.disparity_px.setTo(0);
  for (int row = 0; row < size_px_.height;) {
    const Band band = bandFrom(row);
    sweepBand(band);
    row = band.end_row;
  }
  return winners_;
}

CostSweep::Band CostSweep::bandFrom(int first_row) const {
  const int rows = size_px_.height;
  const int band_rows = std::max(kSmallestBand_rows, kBandPixels / size_px_.width);
  Band band;
  band.first_row = first_row;
  // A remainder smaller than half a band joins this one: its border rows would cost more than it.
  band.end_row = rows - first_row < band_rows * 3 / 2 ? rows : first_row + band_rows;
  band.first_sum = std::max(0, band.first_row - kCoarseSteps * input_.window_px);
  band.end_sum = std::min(rows, band.end_row + kCoarseSteps * input_.window_px);
  band.first_pair = std::max(0, band.first_sum - radius_px_);
  band.end_pair = std::min(rows, band.end_sum + radius_px_);
  return band;
}

void CostSweep::sweepBand(const Band& band) {
  const int last = input_.max_disparity_px + 1;
  for (int plane : {1, 2})  // before disparity 0: nothing
    costs_[static_cast<std::size_t>(plane)].rowRange(band.first_row, band.end_row).setTo(Winners::kNoCost);
  for (int disparity_px = 0; disparity_px <= last; ++disparity_px) {
    pairCosts(band, disparity_px);
    fineSums(band);
    windowCosts(band, disparity_px);
    keepBest(band, disparity_px - 1);
    std::swap(costs_[1], costs_[2]);
    std::swap(costs_[0], costs_[1]);
  }
  costs_[0].rowRange(band.first_row, band.end_row).setTo(Winners::kNoCost);
  keepBest(band, last);
}

void CostSweep::pairCosts(const Band& band, int disparity_px) {
  std::uint8_t* costs = pair_costs_[0];
  for (int row = band.first_pair; row < band.end_pair; ++row) {
    const SeenRow first = seenRow(input_.views[0], row, disparity_px);
    const SeenRow second = input_.views.size() > 1 ? seenRow(input_.views[1], row, disparity_px) : SeenRow();
    pairCostRow((*input_.reference_census)[row], first, second, {0, size_px_.width}, costs + radius_px_);
    mirrorEnds(costs, radius_px_, size_px_.width);
    sumAlongRow(costs, input_.window_px, row_sums_[row], size_px_.width);
  }
}

void CostSweep::fineSums(const Band& band) {
  const int rows = size_px_.height, border = kCoarseSteps * input_.window_px;
  for (int row = band.first_sum; row < band.end_sum; ++row) {
    std::uint16_t* sums = fine_sums_[row] + border;
    if (row == band.first_sum) {
      std::fill(sums, sums + size_px_.width, std::uint16_t{0});
      for (int i = -radius_px_; i <= radius_px_; ++i)
        addRow(row_sums_[mirrored(row + i, rows)], sums, size_px_.width);
    } else {
      slideRow(fine_sums_[row - 1] + border, row_sums_[mirrored(row + radius_px_, rows)],
               row_sums_[mirrored(row - 1 - radius_px_, rows)], sums, size_px_.width);
    }
  }
  for (int row = band.first_sum; row < band.end_sum; ++row)
    mirrorEnds(fine_sums_[row], border, size_px_.width);
}

// Columns of 3 and 5 fine windows: outer = S(-2) + .. + S(2), inner = outer + 2 (S(-1) + S(0) + S(1)).
void CostSweep::sumColumns(int row) {
  const int rows = size_px_.height, step = input_.window_px;
  std::array<const std::uint16_t*, 2 * kCoarseSteps + 1> sums{};
  for (int i = -kCoarseSteps; i <= kCoarseSteps; ++i)
    sums[static_cast<std::size_t>(i + kCoarseSteps)] = fine_sums_[mirrored(row + i * step, rows)];
  std::uint16_t *inner = inner_[0], *outer = outer_[0];
  const int width = size_px_.width + 2 * kCoarseSteps * step;
  for (int x = 0; x < width; x += kLanes) {
    const cv::v_uint16x8 three = cv::v_load(sums[1] + x) + cv::v_load(sums[2] + x) + cv::v_load(sums[3] + x);
    const cv::v_uint16x8 five = three + cv::v_load(sums[0] + x) + cv::v_load(sums[4] + x);
    cv::v_store(outer + x, five);
    cv::v_store(inner + x, five + three + three);
  }
}

void CostSweep::windowCosts(const Band& band, int disparity_px) {
  const int step = input_.window_px;
  const std::uint16_t *inner = inner_[0], *outer = outer_[0];
  const cv::v_uint16x8 fine_weight = cv::v_setall_u16(kFineWeight);
  for (int row = band.first_row; row < band.end_row; ++row) {
    sumColumns(row);
    const std::uint16_t* fine = fine_sums_[row] + kCoarseSteps * step;
    short* costs = costs_[0][row];
    for (int x = 0; x < size_px_.width; x += kLanes) {
      const cv::v_uint16x8 coarse = cv::v_load(inner + x + step) + cv::v_load(inner + x + 2 * step) +
                                    cv::v_load(inner + x + 3 * step) + cv::v_load(outer + x) +
                                    cv::v_load(outer + x + 4 * step);
      const cv::v_uint16x8 sum = coarse + cv::v_mul_wrap(cv::v_load(fine + x), fine_weight);
      cv::v_store(costs + x, cv::v_reinterpret_as_s16(cv::v_shr<1>(sum)));
    }
    maskUnseen(costs, row, disparity_px);
  }
}

void CostSweep::maskUnseen(short* costs, int row, int disparity_px) const {
  int begin = size_px_.width, end = 0;  // columns that some camera sees; the cameras' parts always touch
  for (const SecondaryView& view : input_.views) {
    const SeenRow seen = seenRow(view, row, disparity_px);
    if (seen.begin >= seen.end) continue;
    begin = std::min(begin, seen.begin);
    end = std::max(end, seen.end);
  }
  std::fill(costs, costs + std::min(begin, size_px_.width), Winners::kNoCost);
  std::fill(costs + std::max(end, 0), costs + size_px_.width, Winners::kNoCost);
}

// Looks at the costs of `disparity_px` (costs_[1]) between its neighbours (costs_[2] before, costs_[0]
// after).
void CostSweep::keepBest(const Band& band, int disparity_px) {
  const cv::v_int16x8 none = cv::v_setall_s16(Winners::kNoCost);
  const cv::v_int16x8 candidate = cv::v_setall_s16(static_cast<short>(disparity_px));
  for (int row = band.first_row; row < band.end_row; ++row) {
    const short *before = costs_[2][row], *here = costs_[1][row], *after = costs_[0][row];
    short *best = winners_.cost[row], *second = winners_.second_cost[row],
          *winner = winners_.disparity_px[row];
    short *best_before = winners_.cost_before[row], *best_after = winners_.cost_after[row];
    for (int x = 0; x < size_px_.width; x += kLanes) {
      const cv::v_int16x8 b = cv::v_load(before + x), h = cv::v_load(here + x), a = cv::v_load(after + x);
      const cv::v_int16x8 cost = cv::v_select((b > h) & (h <= a), h, none);
      const cv::v_int16x8 old_second = cv::v_load(second + x);
      if (!cv::v_check_any(cost < old_second)) continue;  // most disparities are nobody's best
      const cv::v_int16x8 old_best = cv::v_load(best + x);
      const cv::v_int16x8 wins = cost < old_best;
      cv::v_store(second + x, cv::v_min(old_second, cv::v_max(old_best, cost)));
      cv::v_store(best + x, cv::v_min(old_best, cost));
      cv::v_store(winner + x, cv::v_select(wins, candidate, cv::v_load(winner + x)));
      cv::v_store(best_before + x, cv::v_select(wins, b, cv::v_load(best_before + x)));
      cv::v_store(best_after + x, cv::v_select(wins, a, cv::v_load(best_after + x)));
    }
  }
}

}  // namespace cornerstone
