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

int SurfaceFilter::join(int one, int other) {
  const int first = rootOf(one), second = rootOf(other);
  const auto [kept, given_up] = std::minmax(first, second);
  if (kept == given_up) return kept;
  Surface &into = surfaces_[static_cast<std::size_t>(kept)],
          &from = surfaces_[static_cast<std::size_t>(given_up)];
  from.parent = kept;
  into.pixels += from.pixels;
  into.strong += from.strong;
  return kept;
}

int SurfaceFilter::surfaceOf(const Run& run, float step_px) {
  int surface = kNone, joined = kNone;
  for (int x = run.begin; x < run.end; ++x) {
    const int above = run.labels_above[x];
    if (above == joined || above == kNone || std::abs(run.here[x] - run.above[x]) > step_px) continue;
    joined = above;
    surface = surface == kNone ? rootOf(above) : join(surface, above);
  }
  if (surface != kNone) return surface;
  surface = static_cast<int>(surfaces_.size());
  surfaces_.push_back({surface, 0, 0});
  return surface;
}

void SurfaceFilter::label(const cv::Mat1f& disparity_px, const cv::Mat1b& evidence, float step_px) {
  const int width = disparity_px.cols;
  labels_.create(disparity_px.size());
  nothing_above_.assign(static_cast<std::size_t>(width), kNone);
  surfaces_.clear();
  for (int y = 0; y < disparity_px.rows; ++y) {
    const float* here = disparity_px[y];
    int* labels = labels_[y];
    Run run{here, disparity_px[std::max(y - 1, 0)], y > 0 ? labels_[y - 1] : nothing_above_.data()};
    for (; run.begin < width; run.begin = run.end) {
      run.end = run.begin + 1;
      if (!(here[run.begin] > 0)) {
        labels[run.begin] = kNone;
        continue;
      }
      while (run.end < width && here[run.end] > 0 && std::abs(here[run.end] - here[run.end - 1]) <= step_px)
        ++run.end;
      const int found = surfaceOf(run, step_px);
      std::fill(labels + run.begin, labels + run.end, found);
      Surface& surface = surfaces_[static_cast<std::size_t>(found)];
      surface.pixels += run.end - run.begin;
      surface.strong += static_cast<int>(std::count(evidence[y] + run.begin, evidence[y] + run.end,
                                                    static_cast<std::uint8_t>(Evidence::kStrong)));
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
