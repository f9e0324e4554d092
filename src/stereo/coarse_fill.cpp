#include "cornerstone/stereo/coarse_fill.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cornerstone/stereo/pixel_cost.h"

namespace cornerstone {
namespace {

constexpr int kFactor = CoarseFill::kFactor, kSquare = kFactor * kFactor;
// Of a difference at 2 px in an image smoothed by 3 x 3. 1: half as many more missed columns in the hall;
// 6: a third more.
constexpr int kFeatureReach_px = 3;
// Of the fine pixels in an area. Where more have answers, it is no area without them. Half, on photographs
// enlarged to 700 px: a quarter more phantom columns; double: half as many more missed columns in a hall.
constexpr double kSilentShare = 0.5;
// Of the coarse pixels in an area: cuts what ends along a line back by the reach of the features, within
// which its outline is all that a pixel need show. Half, likewise: a quarter more phantom columns; 0.9:
// thrice as many missed ones in the hall.
constexpr double kShownShare = 0.75;

// Of a row of squares, how many pixels of each are silent.
void countSilent(const cv::Mat1b& rejection, int row, std::uint8_t* silent) {
  std::fill_n(silent, rejection.cols / kFactor, std::uint8_t{0});
  for (int y = row * kFactor; y < (row + 1) * kFactor; ++y)
    for (int x = 0; x < rejection.cols / kFactor * kFactor; ++x)
      silent[x / kFactor] = static_cast<std::uint8_t>(silent[x / kFactor] + (rejection(y, x) != 0));
}

}  // namespace

void CoarseFill::shrink(const cv::Mat1b& image, cv::Mat1b& shrunk) {
  const cv::Size size = image.size() / kFactor;
  cv::resize(image(cv::Rect({0, 0}, size * kFactor)), shrunk, size, 0, 0, cv::INTER_AREA);
}

bool CoarseFill::findSilent(const cv::Mat1b& rejection, int coarse_window_px, Workers& workers) {
  area_px_ = 2 * (coarse_window_px / 2 + kFeatureReach_px) + 1;
  silent_.create(rejection.rows / kFactor, rejection.cols / kFactor);
  wanted_.create(silent_.size());
  workers.share(silent_.rows, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) countSilent(rejection, y, silent_[y]);
  });
  box_sums_.compute(silent_, area_px_, silent_sums_);
  const int least = static_cast<int>(kSilentShare * kSquare * area_px_ * area_px_);
  int found = 0;
  for (int y = 0; y < wanted_.rows; ++y)
    for (int x = 0; x < wanted_.cols; ++x) {
      const auto wanted = static_cast<std::uint8_t>(silent_sums_(y, x) >= least);
      wanted_(y, x) = wanted;
      found += wanted;
    }
  return found > 0;
}

// Coarse pixels with an answer that show themselves that it is right, as far as it matters.
void CoarseFill::findShown(const Coarse& coarse, Workers& workers) {
  box_sums_.compute(wanted_, area_px_, wanted_sums_);
  shown_.create(wanted_.size());
  workers.share(shown_.rows, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < shown_.cols; ++x) {
        shown_(y, x) = 0;
        if (wanted_sums_(y, x) == 0 || coarse.disparity.rejection(y, x) != 0) continue;
        const int own_px = static_cast<int>(std::lround(coarse.disparity.disparity_px(y, x)));
        const double own_cost = costAround(coarse.sweep, {x, y}, own_px);
        const bool shows = costsMoreAside(coarse.sweep, {x, y}, own_px,
                                          coarse.smallest_cost_ratio * own_cost + kNoiseCostAround);
        shown_(y, x) = static_cast<std::uint8_t>(shows);
      }
  });
}

void CoarseFill::findUsed(Workers& workers) {
  box_sums_.compute(shown_, area_px_, shown_sums_);
  used_.create(shown_.size());
  const int least = static_cast<int>(std::ceil(kShownShare * area_px_ * area_px_));
  workers.share(used_.rows, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < used_.cols; ++x)
        used_(y, x) =
            static_cast<std::uint8_t>(wanted_(y, x) != 0 && shown_(y, x) != 0 && shown_sums_(y, x) >= least);
  });
}

// The fine pixels between the middles of the coarse one at `cell`, its neighbours to the right and below, and
// the one below to the right.
void CoarseFill::fillBetween(const Coarse& coarse, cv::Point cell, Disparity& disparity) const {
  const auto at = [&](const cv::Mat1f& plane, int i) { return plane(cell.y + i / 2, cell.x + i % 2); };
  cv::Vec4f corners_px;
  float sigma_px = 0;
  for (int i = 0; i < 4; ++i) {
    if (used_(cell.y + i / 2, cell.x + i % 2) == 0) return;
    corners_px[i] = at(coarse.disparity.disparity_px, i) * kFactor;
    sigma_px = std::max(sigma_px, at(coarse.disparity.sigma_px, i) * kFactor);
  }
  const auto [least_px, largest_px] = std::minmax_element(corners_px.val, corners_px.val + 4);
  if (*largest_px - *least_px > coarse.largest_step_px * kFactor) return;
  for (int i = 0; i < kSquare; ++i) {
    const cv::Point fine = cell * kFactor + cv::Point(kFactor / 2 + i % kFactor, kFactor / 2 + i / kFactor);
    if (disparity.rejection(fine) == 0) continue;
    const float right = (static_cast<float>(i % kFactor) + 0.5F) / kFactor,
                below = (static_cast<float>(i / kFactor) + 0.5F) / kFactor;
    disparity.disparity_px(fine) = (1 - below) * ((1 - right) * corners_px[0] + right * corners_px[1]) +
                                   below * ((1 - right) * corners_px[2] + right * corners_px[3]);
    disparity.sigma_px(fine) = sigma_px;
    disparity.rejection(fine) = static_cast<std::uint8_t>(Rejection::kNone);
  }
}

void CoarseFill::fill(const Coarse& coarse, Workers& workers, Disparity& disparity) {
  findShown(coarse, workers);
  findUsed(workers);
  workers.share(used_.rows - 1, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x + 1 < used_.cols; ++x) fillBetween(coarse, {x, y}, disparity);
  });
}

}  // namespace cornerstone
