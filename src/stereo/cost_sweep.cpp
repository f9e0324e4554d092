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
// walls, a depth step costs as much as one pixel without any match.
constexpr int kSlopePenalty = 40, kJumpPenalty = 66;
// A depth step costs so much less for each grey level of a brightness step, down to a slope's penalty.
constexpr int kPenaltyPerGrey = 3;

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

void CostSweep::prepare(SweepInput& input) {
  input_ = &input;
  kernels_ = &sweepKernels();
  size_px_ = input.reference->size();
  disparities_ = disparitiesFor(input.max_disparity_px);
  rows_known_ = 0;
  const int width = size_px_.width, window = input.window_px, radius = window / 2;
  const int row_costs = width * disparities_ + kSlack, path_costs = width * (disparities_ + 2) + kSlack;
  entering_.resize(static_cast<std::size_t>(width + window));
  leaving_.resize(static_cast<std::size_t>(width + window));
  for (int x = -window; x < width; ++x) {  // before the first column: those of its window
    entering_[static_cast<std::size_t>(x + window)] = mirrored(x < 0 ? x + radius + 1 : x + radius, width);
    leaving_[static_cast<std::size_t>(x + window)] = mirrored(x - 1 - radius, width);
  }
  pair_costs_.create(window + 1, row_costs);
  zeros_.create(1, row_costs);
  fillAll<std::uint8_t>(zeros_, 0);
  column_sums_.create(1, row_costs);
  sums_.create(1, row_costs);
  costs_.create(1, row_costs);
  for (cv::Mat1b* paths : {&from_left_, &from_right_, &from_above_}) paths->create(1, path_costs);
  // Nothing above the first row: all zero, between 255s.
  fillAll<std::uint8_t>(from_above_, 0);
  for (int x = 0; x < width; ++x)
    from_above_(0, x * (disparities_ + 2)) = from_above_(0, (x + 1) * (disparities_ + 2) - 1) = 255;
  lowest_above_.create(1, width);
  fillAll<std::uint8_t>(lowest_above_, 0);
  path_sums_.create(1, disparities_ + kSlack);
  jump_ahead_.resize(static_cast<std::size_t>(width));
  jump_down_.resize(static_cast<std::size_t>(width));
  path_winners_.resize(static_cast<std::size_t>(width));
  for (cv::Mat1s* plane :
       {&winners_.disparity_px, &winners_.cost, &winners_.cost_before, &winners_.cost_after})
    plane->create(size_px_);
  winners_.chance_cost.create(size_px_);
  winners_.own_cost.create(size_px_);
  winners_.margin.create(size_px_);
  winners_.lead.create(size_px_);
}

const Winners& CostSweep::run(SweepInput& input) {
  prepare(input);
  endCosts();
  const int width = size_px_.width;
  PathRow paths;
  paths.costs = costs_[0];
  paths.jump_ahead = jump_ahead_.data();
  paths.jump_down = jump_down_.data();
  paths.width = width;
  paths.disparities = disparities_;
  paths.slope_penalty = kSlopePenalty;
  paths.from_left = from_left_[0];
  paths.from_right = from_right_[0];
  paths.from_above = from_above_[0];
  paths.lowest_above = lowest_above_[0];
  paths.sums = path_sums_[0];
  paths.winners = path_winners_.data();
  WindowRow window;
  window.column_sums = column_sums_[0];
  window.window_px = input.window_px;
  window.entering = entering_.data() + window.window_px;
  window.leaving = leaving_.data() + window.window_px;
  window.width = width;
  window.disparities = disparities_;
  window.scale = static_cast<unsigned>(kSearchScale * 65536 / (input.window_px * input.window_px));
  for (int row = 0; row < size_px_.height; ++row) {
    windowSums(row);
    kernels_->windowCosts(window, sums_[0], costs_[0]);
    jumpPenalties(row);
    kernels_->pathsAlong(paths);
    kernels_->pathDown(paths);
    keep(row);
  }
  return winners_;
}

// Pair costs at one disparity of all pixels; where no camera sees them, they stay what they were.
void CostSweep::planeCosts(int disparity_px) {
  constexpr std::uint8_t kUnseen = 255;
  for (std::size_t v = 0; v < 2; ++v) {
    const SecondaryView& view = input_->views[v < input_->view_count ? v : 0];
    camera_planes_[v].create(size_px_);
    fillAll(camera_planes_[v], kUnseen);
    input_->reference->costs(view.features(), view.offsetAt(disparity_px), camera_planes_[v]);
  }
  for (int row = 0; row < size_px_.height; ++row) {
    const std::uint8_t *one = camera_planes_[0][row], *other = camera_planes_[1][row];
    std::uint8_t* out = plane_[row];
    for (int x = 0; x < size_px_.width; ++x) {
      const int a = one[x] == kUnseen ? other[x] : one[x], b = other[x] == kUnseen ? a : other[x];
      out[x] = a == kUnseen ? out[x] : static_cast<std::uint8_t>(a + b);
    }
  }
}

// Window costs of the disparities just outside the search: of the farthest, which all cameras see, and of the
// nearest. Most pixels have neither, so that they also tell what unrelated pixels cost in a place.
void CostSweep::endCosts() {
  plane_.create(size_px_);
  planeCosts(0);
  plane_.copyTo(unseen_costs_);
  box_sums_.compute(plane_, input_->window_px, farthest_);
  planeCosts(disparities_ + 1);
  box_sums_.compute(plane_, input_->window_px, nearest_);
  const cv::Mat& farthest = farthest_;
  cv::max(farthest, nearest_, winners_.chance_cost);
}

std::uint8_t* CostSweep::pairCostsOf(int row) { return pair_costs_[row % pair_costs_.rows]; }

// Moves the sums over the window's rows on to `row`.
void CostSweep::windowSums(int row) {
  const int rows = size_px_.height, radius = input_->window_px / 2, count = size_px_.width * disparities_;
  const auto computeUpTo = [&](int end) {
    for (; rows_known_ < std::min(end, rows); ++rows_known_) {
      PairCostRow pair;
      for (std::size_t c = 0; c < GradientFeatures::kChannels; ++c)
        pair.reference[c] = input_->reference->channel(c)[rows_known_];
      for (std::size_t v = 0; v < input_->view_count; ++v)
        pair.cameras[v] = input_->views[v].linesOf(rows_known_);
      pair.camera_count = static_cast<int>(input_->view_count);
      pair.unseen = unseen_costs_[rows_known_];
      pair.width = size_px_.width;
      pair.disparities = disparities_;
      kernels_->pairCosts(pair, pairCostsOf(rows_known_));
    }
  };
  computeUpTo(row + radius + 1);
  if (row > 0) {
    kernels_->slide(column_sums_[0], pairCostsOf(mirrored(row + radius, rows)),
                    pairCostsOf(mirrored(row - 1 - radius, rows)), count);
    return;
  }
  fillAll<std::uint16_t>(column_sums_, 0);
  for (int i = -radius; i <= radius; ++i)
    kernels_->slide(column_sums_[0], pairCostsOf(mirrored(i, rows)), zeros_[0], count);
}

void CostSweep::jumpPenalties(int row) {
  const std::uint8_t *here = (*input_->reference_image)[row],
                     *above = (*input_->reference_image)[std::max(row - 1, 0)];
  jump_ahead_[0] = kJumpPenalty;
  jumpPenaltiesAt(here + 1, here, size_px_.width - 1, jump_ahead_.data() + 1);
  jumpPenaltiesAt(here, above, size_px_.width, jump_down_.data());
}

void CostSweep::keep(int row) {
  const std::uint8_t* own = pairCostsOf(row);
  const std::uint16_t* sums = sums_[0];
  const short *seen_by_one = input_->views[0].seenOf(row),
              *seen_by_other = input_->views[input_->view_count - 1].seenOf(row);
  short *disparities_px = winners_.disparity_px[row], *costs = winners_.cost[row];
  short *before = winners_.cost_before[row], *after = winners_.cost_after[row];
  std::uint8_t *own_costs = winners_.own_cost[row], *margins = winners_.margin[row],
               *leads = winners_.lead[row];
  const short *nearest = nearest_[row], *farthest = farthest_[row];
  for (int x = 0; x < size_px_.width; ++x, own += disparities_, sums += disparities_) {
    const PathWinner& winner = path_winners_[static_cast<std::size_t>(x)];
    const int i = winner.index;
    const bool seen = i < std::max(seen_by_one[x], seen_by_other[x]);
    disparities_px[x] = static_cast<short>(i + 1);
    costs[x] = seen ? static_cast<short>(sums[i]) : Winners::kNoCost;
    before[x] = i > 0 ? static_cast<short>(sums[i - 1]) : farthest[x];
    after[x] = i + 1 < disparities_ ? static_cast<short>(sums[i + 1]) : nearest[x];
    own_costs[x] = own[i];
    margins[x] = winner.margin;
    leads[x] = winner.lead;
  }
}

}  // namespace cornerstone
