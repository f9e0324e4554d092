#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, StereoParams& params) {
  visitor.field("max_disparity_px", params.max_disparity_px);
  visitor.field("window_px", params.window_px);
  visitor.field("smallest_margin_share", params.smallest_margin_share);
  visitor.field("smallest_edge_cost_ratio", params.smallest_edge_cost_ratio);
  visitor.field("largest_own_share", params.largest_own_share);
  visitor.field("left_right_tolerance_px", params.left_right_tolerance_px);
  visitor.field("largest_sigma_px", params.largest_sigma_px);
  visitor.field("subpixel_support_px", params.subpixel_support_px);
  visitor.field("smallest_surface_share", params.smallest_surface_share);
  visitor.field("strong_product", params.strong_product);
  visitor.field("smallest_strong_windows", params.smallest_strong_windows);
  visitor.field("surface_step_px", params.surface_step_px);
  visitor.field("coarse_level", params.coarse_level);
  visitor.field("threads", params.threads);
}

}  // namespace cornerstone
