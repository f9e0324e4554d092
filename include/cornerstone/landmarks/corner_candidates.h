// First guesses for the corner fit (paper, section 3.2): places where two lines at a right angle can run from
// in the dilated edges. The paper looks in 8 directions; 16 leave no gap between them. Yaw is one of 16
// directions, the position a cell's centre: right to the dilation and 11 degrees, which the fit makes good.
#pragma once

#include <vector>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/landmarks/distance_field.h"

namespace cornerstone {

// Best first; poses in metres of the map's frame.
std::vector<Pose2> findCornerCandidates(const DistanceField& field, const GridGeometry& geometry,
                                        const LandmarkParams& params);

}  // namespace cornerstone
