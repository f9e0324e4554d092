// Edges moved onto the surface that was measured. Where occupancy crosses one half depends on how thick a
// wall was drawn: from near or far, often or seldom, up to 35 mm before the surface. The looks' mean does
// not, so that two robots' edges of one wall meet there. Metres of the map's frame.
#pragma once

#include <vector>

#include "cornerstone/landmarks/edge_index.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// Each edge moves along its normal; where no surface is known beside it, it stays. In the index's order.
std::vector<EdgePoint> edgesOnSurface(const EdgeIndex& edges, const std::vector<SurfacePoint>& surface);

}  // namespace cornerstone
