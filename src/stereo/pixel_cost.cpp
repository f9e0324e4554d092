#include "cornerstone/stereo/pixel_cost.h"

#include <algorithm>

namespace cornerstone {

double costAround(const SweepInput& input, cv::Point at, int disparity_px) {
  const cv::Rect inner({1, 1}, input.reference->size() - cv::Size(2, 2));
  if (!inner.contains(at)) return kUnrelatedCostAround;
  int sum = 0, cameras = 0;
  for (std::size_t v = 0; v < input.view_count; ++v) {
    const cv::Point seen = at + input.views[v].offsetAt(disparity_px);
    if (!inner.contains(seen)) continue;
    ++cameras;
    sum += input.reference->costAround(at, input.views[v].features(), seen);
  }
  return cameras > 0 ? static_cast<double>(sum) / cameras : kUnrelatedCostAround;
}

bool costsMoreAside(const SweepInput& input, cv::Point at, int own_px, double smallest_cost) {
  constexpr int kAside_px = 3;  // a texture seen at a disparity that is off by so much no longer fits
  return costAround(input, at, own_px + kAside_px) >= smallest_cost &&
         costAround(input, at, std::max(own_px - kAside_px, 0)) >= smallest_cost;
}

}  // namespace cornerstone
