#include "cornerstone/stereo/surfaces.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

constexpr int kNone = -1;

}  // namespace

int SurfaceFilter::rootOf(int surface) {
  while (surfaces_[static_cast<std::size_t>(surface)].parent != surface) {
    Surface& here = surfaces_[static_cast<std::size_t>(surface)];
    here.parent =
        surfaces_[static_cast<std::size_t>(here.parent)].parent;  // halves the way of the next search
    surface = here.parent;
  }
  return surface;
}

void SurfaceFilter::join(int one, int other) {
  const int first = rootOf(one), second = rootOf(other);
  const auto [kept, given_up] = std::minmax(first, second);
  if (kept == given_up) return;
  Surface &into = surfaces_[static_cast<std::size_t>(kept)],
          &from = surfaces_[static_cast<std::size_t>(given_up)];
  from.parent = kept;
  into.pixels += from.pixels;
  into.strong += from.strong;
}

void SurfaceFilter::label(const cv::Mat1f& disparity_px, const cv::Mat1b& evidence, float step_px) {
  labels_.create(disparity_px.size());
  surfaces_.clear();
  for (int y = 0; y < disparity_px.rows; ++y) {
    const float *here = disparity_px[y], *above = disparity_px[std::max(y - 1, 0)];
    const std::uint8_t* evidence_here = evidence[y];
    int *labels = labels_[y], *labels_above = labels_[std::max(y - 1, 0)];
    int run = kNone;  // surface of the pixel to the left
    for (int x = 0; x < disparity_px.cols; ++x) {
      if (!(here[x] > 0)) {
        labels[x] = run = kNone;
        continue;
      }
      if (run == kNone || std::abs(here[x] - here[x - 1]) > step_px) run = kNone;
      const bool joins_above = y > 0 && above[x] > 0 && std::abs(here[x] - above[x]) <= step_px;
      if (joins_above && run == kNone) run = rootOf(labels_above[x]);
      if (run == kNone) {
        run = static_cast<int>(surfaces_.size());
        surfaces_.push_back({run, 0, 0});
      } else if (joins_above && labels_above[x] != run) {
        join(run, labels_above[x]);
        run = rootOf(run);
      }
      labels[x] = run;
      Surface& surface = surfaces_[static_cast<std::size_t>(run)];
      ++surface.pixels;
      surface.strong += evidence_here[x] == static_cast<std::uint8_t>(Evidence::kStrong);
    }
  }
}

SurfaceFilter::Verdict SurfaceFilter::verdictOn(const Surface& surface, const SurfaceParams& params) {
  if (surface.pixels < params.smallest_px) return kSmall;
  return surface.strong < params.smallest_strong_px ? kWeak : kGood;
}

void SurfaceFilter::judge(const cv::Mat1f& disparity_px, const cv::Mat1b& evidence,
                          const SurfaceParams& params, cv::Mat1b& verdicts) {
  label(disparity_px, evidence, params.step_px);
  verdict_of_.assign(1, kGood);         // of label kNone
  for (Surface& surface : surfaces_) {  // parents come first, so that one look leads to the root
    surface.parent = surfaces_[static_cast<std::size_t>(surface.parent)].parent;
    verdict_of_.push_back(verdictOn(surfaces_[static_cast<std::size_t>(surface.parent)], params));
  }
  verdicts.create(disparity_px.size());
  const std::uint8_t* verdict_of = verdict_of_.data() + 1;
  for (int y = 0; y < labels_.rows; ++y) {
    const int* labels = labels_[y];
    std::uint8_t* out = verdicts[y];
    for (int x = 0; x < labels_.cols; ++x) out[x] = verdict_of[labels[x]];
  }
}

}  // namespace cornerstone
