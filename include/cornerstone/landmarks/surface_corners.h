// Corners settled on the surface that was measured beside their arms. A drawn corner is rounded, more where
// it was seen from one side only, and the edges there bend the arms by centimetres; the looks' means do not.
// Metres of the map's frame.
#pragma once

#include <vector>

#include "cornerstone/landmarks/corner.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

class SurfaceCorners {
 public:
  SurfaceCorners(std::vector<SurfacePoint> surface, double arm_length_m);

  // The corner moved, with the covariance that the surface gives it. As it was where the surface covers too
  // little of an arm, or lies too far from it to be its own.
  CornerLandmark settled(const CornerLandmark& corner) const;

 private:
  std::vector<SurfacePoint> surface_;  // rising x
  double arm_length_m_;
};

}  // namespace cornerstone
