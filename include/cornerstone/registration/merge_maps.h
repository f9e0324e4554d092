// One map from two that share a frame.
#pragma once

#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// In the reference map's frame and resolution, large enough for both. Each cell of the result takes the
// evidence of the cell under it in either map: the log-odds of both are added where both have seen it. Cells
// of the current map are looked up (nearest), never splattered, so that its walls neither smear nor get
// holes.
GridMap mergeMaps(const GridMap& reference, const GridMap& current, const Pose2& reference_from_current);

}  // namespace cornerstone
