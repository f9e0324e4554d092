#include "cornerstone/stereo/outline_check.h"

#include <algorithm>
#include <cstdlib>

#include "cornerstone/stereo/disparity.h"

namespace cornerstone {
namespace {

constexpr int kStep_px = 1;          // neighbours on one surface differ by no more
constexpr int kFeatureReach_px = 3;  // of a difference at 2 px in an image smoothed by 3 x 3
constexpr int kEdgeWidth_px = 2;     // a blurred edge's steepest place lies so much behind its beginning
// Smoothing leaves a third of a camera's noise, which is at most 4 grey levels: twice what that makes of a
// difference. Half or double: a tenth more phantom columns.
constexpr int kEven_grey = 4;
constexpr int kLeastEdge_grey = 3 * kEven_grey;
// The outline itself lies within so many pixels outside when the surface ends where it should; it is then at
// least a third as strong as what is found inside. Double of either: a fifth more phantom columns.
constexpr int kOutside_px = 3, kOutsideShare = 3;

// The first brightness edge from a pixel on. `ahead_px`: pixels before its steepest place; 0: none.
struct BrightnessEdge {
  int ahead_px = 0, strength_grey = 0;
};

BrightnessEdge edgeFrom(const std::uint8_t* grey, std::ptrdiff_t step, int reach_px) {
  const auto away = [&](int k, int from) { return std::abs(grey[k * step] - grey[from * step]); };
  int begins = 1;
  while (begins <= reach_px && away(begins, 0) <= kEven_grey) ++begins;
  if (begins > reach_px) return {};
  BrightnessEdge edge;
  int steepest_grey = 0;
  for (int k = begins; k <= begins + kEdgeWidth_px; ++k) {
    edge.strength_grey = std::max(edge.strength_grey, away(k, 0));
    if (away(k, k - 1) <= steepest_grey) continue;
    steepest_grey = away(k, k - 1);
    edge.ahead_px = k;
  }
  return edge.strength_grey < kLeastEdge_grey ? BrightnessEdge{} : edge;
}

bool endsAtAnEdge(const std::uint8_t* grey, std::ptrdiff_t outward, int inner_strength_grey) {
  for (int k = 1; k <= kOutside_px; ++k)
    if (std::abs(grey[k * outward] - grey[0]) * kOutsideShare >= inner_strength_grey) return true;
  return false;
}

}  // namespace

void OutlineCheck::checkSide(const Winners& winners, const cv::Mat1b& grey, cv::Point at, cv::Point outward) {
  const int own_px = winners.disparity_px(at);
  cv::Point beyond = at + outward;
  const auto ahead = [&] { return own_px - winners.disparity_px(beyond); };
  // Small holes in a surface are no end of it.
  const cv::Rect image({0, 0}, grey.size());
  const int hole_px = window_radius_px_ + 1;
  int gap_px = 0;
  while (gap_px < hole_px && image.contains(beyond) && before_(beyond) != 0 &&
         std::abs(ahead()) <= kStep_px) {
    beyond += outward;
    ++gap_px;
  }
  if (!image.contains(beyond)) return;
  if (gap_px < hole_px && before_(beyond) == 0 && ahead() <= kStep_px) return;
  const std::ptrdiff_t step = outward.y * static_cast<std::ptrdiff_t>(grey.step) + outward.x;
  const int reach_px = window_radius_px_ + kFeatureReach_px;
  const BrightnessEdge edge = edgeFrom(&grey(at), -step, reach_px);
  if (edge.ahead_px == 0 || endsAtAnEdge(&grey(at), step, edge.strength_grey)) return;
  for (int k = 0; k < edge.ahead_px; ++k) {
    const cv::Point here = at - k * outward;
    if (std::abs(winners.disparity_px(here) - own_px) > 2 * kStep_px) return;
    outlying_.push_back(here);
  }
}

void OutlineCheck::check(const Winners& winners, const SweepInput& input, cv::Mat1b& rejection) {
  window_radius_px_ = input.window_px / 2;
  const int margin = window_radius_px_ + kFeatureReach_px + kEdgeWidth_px;
  rejection.copyTo(before_);
  outlying_.clear();
  for (int y = margin; y < rejection.rows - margin; ++y)
    for (int x = margin; x < rejection.cols - margin; ++x) {
      if (before_(y, x) != 0) continue;
      const int own_px = winners.disparity_px(y, x);
      for (const cv::Point outward : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
        const cv::Point next = cv::Point(x, y) + outward;
        if (before_(next) == 0 && std::abs(own_px - winners.disparity_px(next)) <= kStep_px) continue;
        checkSide(winners, input.reference->smooth(), {x, y}, outward);
      }
    }
  for (const cv::Point at : outlying_)
    if (rejection(at) == 0) rejection(at) = static_cast<std::uint8_t>(Rejection::kUniqueness);
}

}  // namespace cornerstone
