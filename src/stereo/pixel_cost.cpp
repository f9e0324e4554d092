#include "cornerstone/stereo/pixel_cost.h"

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

}  // namespace cornerstone
