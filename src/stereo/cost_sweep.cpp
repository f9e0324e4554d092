#include "cornerstone/stereo/cost_sweep.h"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>

#include "cornerstone/stereo/pair_cost.h"

namespace cornerstone {
namespace {

constexpr int kLanes = 8;
constexpr int kFineWeight =
    9;  // the fine window against its 3 x 3: both count alike, summed over their pixels
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

void addRow(const std::uint8_t* values, std::uint16_t* sums, int width) {
  for (int x = 0; x < width; x += kLanes)
    cv::v_store(sums + x, cv::v_add_wrap(cv::v_load(sums + x), cv::v_load_expand(values + x)));
}

void subtractRow(const std::uint8_t* values, std::uint16_t* sums, int width) {
  for (int x = 0; x < width; x += kLanes)
    cv::v_store(sums + x, cv::v_sub_wrap(cv::v_load(sums + x), cv::v_load_expand(values + x)));
}

// out[x] = sum of in[x] .. in[x + window - 1]
void sumAlongRow(const std::uint16_t* in, int window, std::uint16_t* out, int width) {
  for (int x = 0; x < width; x += kLanes) {
    cv::v_uint16x8 sum = cv::v_load(in + x);
    for (int i = 1; i < window; ++i) sum = cv::v_add_wrap(sum, cv::v_load(in + x + i));
    cv::v_store(out + x, sum);
  }
}

}  // namespace

void CostSweep::prepare(const SweepInput& input) {
  input_ = input;
  size_px_ = input.reference_census->size();
  radius_px_ = input.window_px / 2;
  const int width = roundUp(size_px_.width), rows = size_px_.height;
  pair_costs_.create(rows, width + 2 * input.window_px + kLanes);
  column_sums_.create(1, width + 2 * input.window_px + kLanes);
  fine_sums_.create(rows, width + 2 * input.window_px + kLanes);
  three_rows_.create(1, width + 2 * input.window_px + kLanes);
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
  band.first_sum = std::max(0, band.first_row - input_.window_px);
  band.end_sum = std::min(rows, band.end_row + input_.window_px);
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
  for (int row = band.first_pair; row < band.end_pair; ++row) {
    const SeenRow first = seenRow(input_.views[0], row, disparity_px);
    const SeenRow second = input_.views.size() > 1 ? seenRow(input_.views[1], row, disparity_px) : SeenRow();
    pairCostRow((*input_.reference_census)[row], first, second, {0, size_px_.width},
                pair_costs_[row] + radius_px_);
    mirrorEnds(pair_costs_[row], radius_px_, size_px_.width);
  }
}

void CostSweep::fineSums(const Band& band) {
  const int rows = size_px_.height, width = roundUp(size_px_.width + 2 * radius_px_),
            border = input_.window_px;
  std::uint16_t* columns = column_sums_[0];
  std::fill(columns, columns + column_sums_.cols, std::uint16_t{0});
  for (int i = -radius_px_; i < radius_px_; ++i)
    addRow(pair_costs_[mirrored(band.first_sum + i, rows)], columns, width);
  for (int row = band.first_sum; row < band.end_sum; ++row) {
    addRow(pair_costs_[mirrored(row + radius_px_, rows)], columns, width);
    sumAlongRow(columns, input_.window_px, fine_sums_[row] + border, size_px_.width);
    mirrorEnds(fine_sums_[row], border, size_px_.width);
    subtractRow(pair_costs_[mirrored(row - radius_px_, rows)], columns, width);
  }
}

void CostSweep::windowCosts(const Band& band, int disparity_px) {
  const int rows = size_px_.height, step = input_.window_px, width = size_px_.width;
  std::uint16_t* three = three_rows_[0];
  for (int row = band.first_row; row < band.end_row; ++row) {
    const std::uint16_t* above = fine_sums_[mirrored(row - step, rows)];
    const std::uint16_t* middle = fine_sums_[row];
    const std::uint16_t* below = fine_sums_[mirrored(row + step, rows)];
    for (int x = 0; x < width + 2 * step; x += kLanes)
      cv::v_store(three + x, cv::v_load(above + x) + cv::v_load(middle + x) + cv::v_load(below + x));
    short* costs = costs_[0][row];
    for (int x = 0; x < width; x += kLanes) {
      const cv::v_uint16x8 coarse =
          cv::v_load(three + x) + cv::v_load(three + x + step) + cv::v_load(three + x + 2 * step);
      const cv::v_uint16x8 fine =
          cv::v_mul_wrap(cv::v_load(middle + x + step), cv::v_setall_u16(kFineWeight));
      cv::v_store(costs + x, cv::v_reinterpret_as_s16(coarse + fine));
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
      const cv::v_int16x8 old_best = cv::v_load(best + x);
      const cv::v_int16x8 wins = cost < old_best;
      cv::v_store(second + x, cv::v_min(cv::v_load(second + x), cv::v_max(old_best, cost)));
      cv::v_store(best + x, cv::v_min(old_best, cost));
      cv::v_store(winner + x, cv::v_select(wins, candidate, cv::v_load(winner + x)));
      cv::v_store(best_before + x, cv::v_select(wins, b, cv::v_load(best_before + x)));
      cv::v_store(best_after + x, cv::v_select(wins, a, cv::v_load(best_after + x)));
    }
  }
}

}  // namespace cornerstone
