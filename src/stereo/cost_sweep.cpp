#include "cornerstone/stereo/cost_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cornerstone/stereo/fill.h"

namespace cornerstone {
namespace {

constexpr int kSlack = 64;  // kernels read and write whole vectors

constexpr double kSearchScale = static_cast<double>(kSearchChance) / kChanceCost;  // of the mean pair cost
// Penalties in the costs of the search, see kSearchChance. A slope of one disparity a pixel is rare on
// walls, a depth step costs a third more than one pixel without any match. On photographs half of the first:
// a quarter more phantom columns; steps of 120: a seventh more of these, a quarter more wrong answers; of 66:
// a tenth more missed columns, a fifth fewer phantom ones.
constexpr int kSlopePenalty = 40, kJumpPenalty = 80;
// A depth step costs so much less for each grey level of a brightness step, down to a slope's penalty.
constexpr int kPenaltyPerGrey = 3;

// What is kept of a round's rows should stay in the cache of two workers; each row then costs them a fraction
// of what waiting for each other does.
constexpr int kRoundBytes = 1 << 22;

// Where a camera's lines lie across the rows, each pixel's are in other cache lines, which all rows of a
// stretch of columns use in turn.
constexpr int kRowsTogether = 4, kColumnsTogether = 32;

void jumpPenaltiesAt(const std::uint8_t* here, const std::uint8_t* before, int count,
                     std::uint8_t* penalties) {
  for (int x = 0; x < count; ++x) {
    const int step_grey = std::abs(here[x] - before[x]);
    penalties[x] =
        static_cast<std::uint8_t>(std::max(kJumpPenalty - kPenaltyPerGrey * step_grey, kSlopePenalty));
  }
}

}  // namespace

int CostSweep::disparitiesFor(int max_disparity_px) {
  const int lanes = sweepKernels().lanes;
  return (max_disparity_px + lanes - 1) / lanes * lanes;
}

void CostSweep::prepare(const SweepInput& input, int workers) {
  input_ = &input;
  kernels_ = &sweepKernels();
  size_px_ = input.reference->size();
  disparities_ = disparitiesFor(input.max_disparity_px);
  prepareRows(workers);
  // Stripes narrower than a window would reach beyond their neighbours.
  const int stripes = std::clamp(size_px_.width / (2 * input.window_px), 1, workers);
  stripes_.resize(static_cast<std::size_t>(stripes));
  for (int i = 0; i < stripes; ++i)
    prepareStripe(stripes_[static_cast<std::size_t>(i)],
                  {size_px_.width * i / stripes, size_px_.width * (i + 1) / stripes});
  for (cv::Mat1s* plane :
       {&winners_.disparity_px, &winners_.cost, &winners_.cost_before, &winners_.cost_after})
    plane->create(size_px_);
  winners_.chance_cost.create(size_px_);
  winners_.own_cost.create(size_px_);
  winners_.margin.create(size_px_);
  winners_.lead.create(size_px_);
}

void CostSweep::prepareRows(int workers) {
  const int width = size_px_.width, row_costs = width * disparities_ + kSlack,
            path_costs = width * (disparities_ + 2) + kSlack;
  const int row_bytes = 3 * row_costs + 2 * path_costs;
  const int rows_each = std::max(kRoundBytes / row_bytes / workers, 1);
  round_rows_ = workers == 1 ? 1 : std::min(rows_each * workers, size_px_.height);
  zeros_.create(1, row_costs);
  fillAll<std::uint8_t>(zeros_, 0);
  sums_.create(round_rows_, row_costs);
  costs_.create(round_rows_, row_costs);
  for (cv::Mat1b* paths : {&from_left_, &from_right_}) paths->create(round_rows_, path_costs);
  for (cv::Mat1b* penalties : {&jump_ahead_, &jump_down_}) penalties->create(round_rows_, width);
  // Nothing above the first row: all zero, between 255s.
  from_above_.create(1, path_costs);
  fillAll<std::uint8_t>(from_above_, 0);
  for (int x = 0; x < width; ++x)
    from_above_(0, x * (disparities_ + 2)) = from_above_(0, (x + 1) * (disparities_ + 2) - 1) = 255;
  lowest_above_.create(1, width);
  fillAll<std::uint8_t>(lowest_above_, 0);
}

void CostSweep::prepareStripe(SweepStripe& stripe, const cv::Range& columns) {
  const int width = size_px_.width, window = input_->window_px, radius = window / 2;
  stripe.columns = columns;
  stripe.window_columns = {std::max(columns.start - radius, 0), std::min(columns.end + radius, width)};
  stripe.rows_known = 0;
  const int row_costs = stripe.window_columns.size() * disparities_ + kSlack;
  stripe.pair_costs.create(window + round_rows_ + kRowsTogether, row_costs);
  stripe.column_sums.create(1, row_costs);
  stripe.path_sums.create(1, disparities_ + kSlack);
  stripe.entering.resize(static_cast<std::size_t>(columns.size() + window));
  stripe.leaving.resize(static_cast<std::size_t>(columns.size() + window));
  const auto columnAt = [&](int x) { return mirrored(x, width) - stripe.window_columns.start; };
  for (int i = -window; i < columns.size(); ++i) {  // before the first column: those of its window
    const int x = columns.start + i;
    const auto at = static_cast<std::size_t>(i + window);
    stripe.entering[at] = columnAt(i < 0 ? x + radius + 1 : x + radius);
    stripe.leaving[at] = i < 1 ? 0 : columnAt(x - 1 - radius);
  }
}

const Winners& CostSweep::run(const SweepInput& input, Workers& workers) {
  prepare(input, workers.count());
  endCosts(workers);
  const int rows = size_px_.height;
  for (int first = 0; first < rows + round_rows_; first += round_rows_) {
    const cv::Range round(std::min(first, rows), std::min(first + round_rows_, rows));
    workers.run([&](int worker) {
      if (static_cast<std::size_t>(worker) >= stripes_.size()) return;
      SweepStripe& stripe = stripes_[static_cast<std::size_t>(worker)];
      for (int row = std::max(first - round_rows_, 0); row < round.start; ++row) pathDown(stripe, row);
      for (int row = round.start; row < round.end; ++row) windowCosts(stripe, row);
    });
    workers.share(round.size(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) kernels_->pathsAlong(pathsOf(round.start + i, 0));
    });
  }
  return winners_;
}

PathRow CostSweep::pathsOf(int row, int first_column) {
  const int slot = row % round_rows_;
  const std::ptrdiff_t first_path = std::ptrdiff_t{first_column} * (disparities_ + 2);
  PathRow paths;
  paths.costs = costs_[slot] + std::ptrdiff_t{first_column} * disparities_;
  paths.jump_ahead = jump_ahead_[slot] + first_column;
  paths.jump_down = jump_down_[slot] + first_column;
  paths.width = size_px_.width - first_column;
  paths.disparities = disparities_;
  paths.slope_penalty = kSlopePenalty;
  paths.from_left = from_left_[slot] + first_path;
  paths.from_right = from_right_[slot] + first_path;
  paths.from_above = from_above_[0] + first_path;
  paths.lowest_above = lowest_above_[0] + first_column;
  paths.winners = {winners_.disparity_px[row] + first_column, winners_.margin[row] + first_column,
                   winners_.lead[row] + first_column};
  return paths;
}

void CostSweep::pathDown(SweepStripe& stripe, int row) {
  PathRow paths = pathsOf(row, stripe.columns.start);
  paths.width = stripe.columns.size();
  paths.sums = stripe.path_sums[0];
  kernels_->pathDown(paths);
  keep(stripe, row);
}

void CostSweep::windowCosts(SweepStripe& stripe, int row) {
  columnSums(stripe, row);
  jumpPenalties(stripe, row);
  const int slot = row % round_rows_;
  const std::ptrdiff_t first = std::ptrdiff_t{stripe.columns.start} * disparities_;
  WindowRow window;
  window.column_sums = stripe.column_sums[0];
  window.window_px = input_->window_px;
  window.entering = stripe.entering.data() + window.window_px;
  window.leaving = stripe.leaving.data() + window.window_px;
  window.width = stripe.columns.size();
  window.disparities = disparities_;
  window.scale = static_cast<unsigned>(kSearchScale * 65536 / (window.window_px * window.window_px));
  kernels_->windowCosts(window, sums_[slot] + first, costs_[slot] + first);
}

// Pair costs at one disparity in a row; where no camera sees a pixel, they stay what they were.
void CostSweep::planeCosts(int row, int disparity_px, std::uint8_t* costs) {
  constexpr std::uint8_t kUnseen = 255;
  for (std::size_t v = 0; v < 2; ++v) {
    const SecondaryView& view = input_->views[v < input_->view_count ? v : 0];
    std::fill_n(camera_planes_[v][row], size_px_.width, kUnseen);
    input_->reference->costsOfRow(row, view.features(), view.offsetAt(disparity_px), camera_planes_[v][row]);
  }
  const std::uint8_t *one = camera_planes_[0][row], *other = camera_planes_[1][row];
  const int width = size_px_.width;
  for (int x = 0; x < width; ++x) {
    const std::uint8_t a = one[x] == kUnseen ? other[x] : one[x], b = other[x] == kUnseen ? a : other[x];
    const auto sum = static_cast<std::uint8_t>(a + b);
    costs[x] = a == kUnseen ? costs[x] : sum;
  }
}

// Window costs of the disparities just outside the search: of the farthest, which all cameras see, and of the
// nearest. Most pixels have neither, so that they also tell what unrelated pixels cost in a place.
void CostSweep::endCosts(Workers& workers) {
  for (cv::Mat1b* plane : {&plane_, &unseen_costs_, &camera_planes_[0], &camera_planes_[1]})
    plane->create(size_px_);
  workers.share(size_px_.height, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      planeCosts(row, 0, unseen_costs_[row]);
      std::copy_n(unseen_costs_[row], size_px_.width, plane_[row]);
      planeCosts(row, disparities_ + 1, plane_[row]);
    }
  });
  box_sums_.compute(unseen_costs_, input_->window_px, farthest_);
  box_sums_.compute(plane_, input_->window_px, nearest_);
  const cv::Mat& farthest = farthest_;
  cv::max(farthest, nearest_, winners_.chance_cost);
}

std::uint8_t* CostSweep::pairCostsOf(SweepStripe& stripe, int row) {
  return stripe.pair_costs[row % stripe.pair_costs.rows];
}

void CostSweep::knowPairCosts(SweepStripe& stripe, int end_row) {
  const cv::Range& columns = stripe.window_columns;
  while (stripe.rows_known < std::min(end_row, size_px_.height)) {
    const int first_row = stripe.rows_known;
    stripe.rows_known = std::min(first_row + kRowsTogether, size_px_.height);
    for (int x = columns.start; x < columns.end; x += kColumnsTogether)
      for (int row = first_row; row < stripe.rows_known; ++row)
        pairCosts(stripe, row, {x, std::min(x + kColumnsTogether, columns.end)});
  }
}

void CostSweep::pairCosts(SweepStripe& stripe, int row, const cv::Range& columns) {
  PairCostRow pair;
  for (std::size_t c = 0; c < GradientFeatures::kChannels; ++c)
    pair.reference[c] = input_->reference->channel(c)[row] + columns.start;
  for (std::size_t v = 0; v < input_->view_count; ++v)
    pair.cameras[v] = input_->views[v].linesOf(row, columns, stripe.gathered[v]);
  pair.camera_count = static_cast<int>(input_->view_count);
  pair.unseen = unseen_costs_[row] + columns.start;
  pair.width = columns.size();
  pair.disparities = disparities_;
  const std::ptrdiff_t first = std::ptrdiff_t{columns.start - stripe.window_columns.start} * disparities_;
  kernels_->pairCosts(pair, pairCostsOf(stripe, row) + first);
}

// Moves the sums over the window's rows on to `row`.
void CostSweep::columnSums(SweepStripe& stripe, int row) {
  const int rows = size_px_.height, radius = input_->window_px / 2,
            count = stripe.window_columns.size() * disparities_;
  knowPairCosts(stripe, row + radius + 1);
  if (row > 0) {
    kernels_->slide(stripe.column_sums[0], pairCostsOf(stripe, mirrored(row + radius, rows)),
                    pairCostsOf(stripe, mirrored(row - 1 - radius, rows)), count);
    return;
  }
  fillAll<std::uint16_t>(stripe.column_sums, 0);
  for (int i = -radius; i <= radius; ++i)
    kernels_->slide(stripe.column_sums[0], pairCostsOf(stripe, mirrored(i, rows)), zeros_[0], count);
}

void CostSweep::jumpPenalties(const SweepStripe& stripe, int row) {
  const int slot = row % round_rows_, first = stripe.columns.start, count = stripe.columns.size();
  const std::uint8_t *here = (*input_->reference_image)[row],
                     *above = (*input_->reference_image)[std::max(row - 1, 0)];
  const int left = first == 0 ? 1 : 0;  // nothing stands before the first column
  if (left == 1) jump_ahead_(slot, 0) = kJumpPenalty;
  jumpPenaltiesAt(here + first + left, here + first + left - 1, count - left,
                  jump_ahead_[slot] + first + left);
  jumpPenaltiesAt(here + first, above + first, count, jump_down_[slot] + first);
}

void CostSweep::keep(SweepStripe& stripe, int row) {
  const std::ptrdiff_t first = stripe.columns.start;
  const std::uint8_t* own = pairCostsOf(stripe, row) + (first - stripe.window_columns.start) * disparities_;
  const std::uint16_t* sums = sums_[row % round_rows_] + first * disparities_;
  const short *seen_by_one = input_->views[0].seenOf(row),
              *seen_by_other = input_->views[input_->view_count - 1].seenOf(row);
  const short *disparities_px = winners_.disparity_px[row], *nearest = nearest_[row],
              *farthest = farthest_[row];
  short *costs = winners_.cost[row], *before = winners_.cost_before[row], *after = winners_.cost_after[row];
  std::uint8_t* own_costs = winners_.own_cost[row];
  for (int x = stripe.columns.start; x < stripe.columns.end; ++x, own += disparities_, sums += disparities_) {
    const int i = disparities_px[x] - 1;
    const bool seen = i < std::max(seen_by_one[x], seen_by_other[x]);
    costs[x] = seen ? static_cast<short>(sums[i]) : Winners::kNoCost;
    before[x] = i > 0 ? static_cast<short>(sums[i - 1]) : farthest[x];
    after[x] = i + 1 < disparities_ ? static_cast<short>(sums[i + 1]) : nearest[x];
    own_costs[x] = own[i];
  }
}

}  // namespace cornerstone
