#include "cornerstone/stereo/outline_check.h"

#include <algorithm>
#include <cstdlib>

#include "cornerstone/stereo/marks.h"

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

// What a look from a pixel reaches.
int marginFor(int window_radius_px) { return window_radius_px + kFeatureReach_px + kEdgeWidth_px; }

}  // namespace

void OutlineCheck::checkSide(const Ends& in, cv::Point at, cv::Point outward) const {
  const Winners& winners = in.winners;
  const cv::Mat1b& grey = in.grey;
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
    in.found.outlying.push_back(here);
  }
}

// Marks answered pixels beside a step or a pixel without an answer.
const std::uint8_t* OutlineCheck::endsOf(const Ends& in, int y) const {
  const std::uint8_t *here = before_[y], *above = before_[y - 1], *below = before_[y + 1];
  const std::uint8_t* steps = in.found.steps.of(in.winners.disparity_px, y, 1);
  const int width = before_.cols;  // no store can change it
  in.found.ends.resize(static_cast<std::size_t>(width));
  std::uint8_t* ends = in.found.ends.data();
  for (int x = 1; x < width - 1; ++x) {
    const int beside = here[x - 1] | here[x + 1] | above[x] | below[x] | steps[x];
    ends[x] = static_cast<std::uint8_t>(static_cast<int>(beside != 0) & static_cast<int>(here[x] == 0));
  }
  return ends;
}

void OutlineCheck::checkRow(const Ends& in, int y) const {
  const int margin = marginFor(window_radius_px_);
  const std::uint8_t* ends = endsOf(in, y);
  forEachMarked(ends + margin, before_.cols - 2 * margin, [&](int from_margin) {
    const int x = margin + from_margin;
    const int own_px = in.winners.disparity_px(y, x);
    for (const cv::Point outward : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
      const cv::Point next = cv::Point(x, y) + outward;
      if (before_(next) == 0 && std::abs(own_px - in.winners.disparity_px(next)) <= kStep_px) continue;
      checkSide(in, {x, y}, outward);
    }
  });
}

void OutlineCheck::check(const Winners& winners, const SweepInput& input, Workers& workers,
                         Disparity& disparity) {
  const cv::Mat1b& rejection = disparity.rejection;
  window_radius_px_ = input.window_px / 2;
  rejection.copyTo(before_);
  found_.resize(static_cast<std::size_t>(workers.count()));
  for (Found& found : found_) found.outlying.clear();
  const int margin = marginFor(window_radius_px_);
  workers.share(std::max(rejection.rows - 2 * margin, 0), [&](int begin, int end, int worker) {
    const Ends in{winners, input.reference->smooth(), found_[static_cast<std::size_t>(worker)]};
    for (int y = begin; y < end; ++y) checkRow(in, y + margin);
  });
  for (const Found& found : found_)
    for (const cv::Point at : found.outlying)
      if (rejection(at) == 0) reject(disparity, at, Rejection::kUniqueness);
}

}  // namespace cornerstone
