#include "cornerstone/mapping/grid_map.h"

#include <opencv2/imgproc.hpp>

namespace cornerstone {

Eigen::Vector2d knownCentre(const GridMap& map) {
  if (map.occupied.empty()) return {0, 0};
  const cv::Moments moments = cv::moments(map.occupied != kUnseen, true);
  if (moments.m00 == 0) return {0, 0};
  return map.geometry.toMetres({moments.m10 / moments.m00, moments.m01 / moments.m00});
}

}  // namespace cornerstone
