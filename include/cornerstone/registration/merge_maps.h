// One map from those of several robots that share a frame.
#pragma once

#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

struct PlacedMap {
  GridMap map;
  Pose2 reference_from_map;
};

// In the reference map's frame and resolution, large enough for all. Each cell of the result takes the
// evidence of the cell under it in every map: the log-odds are added where several have seen it. Cells of the
// other maps are looked up (nearest), never splattered, so that walls neither smear nor get holes. Empty maps
// add nothing.
GridMap mergeMaps(const GridMap& reference, const std::vector<PlacedMap>& others);

}  // namespace cornerstone
