#include "cornerstone/stereo/gap_fill.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/stereo/marks.h"
#include "cornerstone/stereo/pixel_cost.h"

namespace cornerstone {
namespace {

constexpr int kStep_px = 1;  // a winner that differs by no more is of the same surface

bool mayHold(std::uint8_t rejection) {
  return rejection != static_cast<std::uint8_t>(Rejection::kOutside) &&
         rejection != static_cast<std::uint8_t>(Rejection::kRange);
}

}  // namespace

// The pixel's own images do not fit clearly worse there than where they fit best.
bool GapFill::fits(const Images& images, cv::Point at, int disparity_px) {
  const int own_px = images.input.winners.disparity_px(at);
  if (std::abs(own_px - disparity_px) <= kStep_px) return true;
  return costAround(images.input.sweep, at, disparity_px) <=
         costAround(images.input.sweep, at, own_px) + kNoiseCostAround;
}

void GapFill::propose(const Images& images, const Gap& gap) {
  const cv::Mat1f &answers_px = images.disparity.disparity_px, &sigmas_px = images.disparity.sigma_px;
  const float before_px = answers_px(gap.before),
              rise_px = (answers_px(gap.after()) - before_px) / static_cast<float>(gap.length_px + 1);
  const float sigma_px = std::max(sigmas_px(gap.before), sigmas_px(gap.after()));
  for (int i = 1; i <= gap.length_px; ++i) {
    const cv::Point at = gap.before + i * gap.step;
    // Of a row and a column, the nearer answers.
    if (gap_px_(at) != 0 && gap_px_(at) <= gap.length_px) continue;
    if (!mayHold(images.disparity.rejection(at))) continue;
    const float between_px = before_px + static_cast<float>(i) * rise_px;
    if (!fits(images, at, static_cast<int>(std::lround(between_px)))) continue;
    gap_px_(at) = static_cast<std::uint8_t>(gap.length_px);
    disparity_px_(at) = between_px;
    sigma_px_(at) = sigma_px;
  }
}

// Looks for the answer before a gap, from the answer after it.
void GapFill::look(const Images& images, cv::Point after, cv::Point step) {
  const cv::Mat1b& rejection = images.disparity.rejection;
  const std::ptrdiff_t back = -(step.y * static_cast<std::ptrdiff_t>(rejection.step) + step.x);
  const int longest_px = std::min(params_.largest_px, (step.x != 0 ? after.x : after.y) - 1);
  const std::uint8_t* before = &rejection(after) + 2 * back;
  int length_px = 1;
  for (; length_px <= longest_px && *before != 0; ++length_px) before += back;
  if (length_px > longest_px) return;
  const Gap gap{after - (length_px + 1) * step, step, length_px};
  const cv::Mat1f& answers_px = images.disparity.disparity_px;
  if (std::abs(answers_px(gap.before) - answers_px(after)) <= params_.largest_step_px) propose(images, gap);
}

void GapFill::lookAlong(const Images& images, int y) {
  std::fill_n(gap_px_[y], gap_px_.cols, std::uint8_t{0});
  const std::uint8_t* rejections = images.disparity.rejection[y];
  forEachMarked(rejections, gap_px_.cols - 1, [&](int x) {
    if (rejections[x + 1] == 0) look(images, {x + 1, y}, {1, 0});
  });
}

void GapFill::lookDown(const Images& images, const cv::Range& columns) {
  const cv::Mat1b& rejection = images.disparity.rejection;
  for (int y = 1; y < gap_px_.rows; ++y) {
    const std::uint8_t *above = rejection[y - 1] + columns.start, *here = rejection[y] + columns.start;
    forEachMarked(above, columns.size(), [&](int x) {
      if (here[x] == 0) look(images, {columns.start + x, y}, {0, 1});
    });
  }
}

void GapFill::accept(int y, Disparity& disparity) const {
  forEachMarked(gap_px_[y], gap_px_.cols, [&](int x) {
    disparity.disparity_px(y, x) = disparity_px_(y, x);
    disparity.sigma_px(y, x) = sigma_px_(y, x);
    disparity.rejection(y, x) = static_cast<std::uint8_t>(Rejection::kNone);
  });
}

// Rows are looked at by themselves and columns by themselves, and nothing is accepted before all have been:
// the answers do not depend on who comes first.
void GapFill::fill(const GapInput& input, const GapParams& params, Disparity& disparity) {
  const cv::Size size = disparity.rejection.size();
  params_ = params;
  for (cv::Mat1f* plane : {&disparity_px_, &sigma_px_}) plane->create(size);
  gap_px_.create(size);
  const Images images{input, disparity};
  Workers& workers = input.workers;
  workers.share(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) lookAlong(images, y);
  });
  workers.share(size.width, [&](int begin, int end) { lookDown(images, {begin, end}); });
  workers.share(size.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) accept(y, disparity);
  });
}

}  // namespace cornerstone
