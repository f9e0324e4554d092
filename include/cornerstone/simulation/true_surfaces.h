// Ground truth of a map: the outlines of all that stands in a band of heights, as a stereo robot's scan would
// meet them. Whatever reaches into the band hides what lies behind it: a scan reports the nearest obstacle of
// a column, however low. World frame, metres.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/simulation/world.h"

namespace cornerstone {

struct HeightBand {
  double z_min_m = 0.15;  // the same band as the scan's: lower is floor, higher does not hinder
  double z_max_m = 1.50;
};

struct Sight {
  double field_of_view_rad = 1.5707963267948966;  // whole angle, around the pose's heading
  double range_m = 3.0;
};

class TrueSurfaces {
 public:
  explicit TrueSurfaces(const std::vector<Solid>& solids, const HeightBand& band = {});

  // Points 0.02 m apart along every outline.
  const std::vector<Eigen::Vector2d>& points() const { return points_m_; }
  // Indices into points(), rising, of what is seen from a pose: in view, in range, nothing before it.
  std::vector<std::size_t> visibleFrom(const Pose2& world_from_camera, const Sight& sight) const;
  // From a point to the nearest outline; infinity in an empty world.
  double distanceTo(const Eigen::Vector2d& point_m) const;

 private:
  struct Edge {
    Eigen::Vector2d from_m, to_m;
    double length_m;
    std::size_t first_point, point_count;
  };
  struct Hit {
    std::size_t edge = 0;
    double along_m = 0;
    double range_m = 0;
  };
  bool cast(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, Hit& hit) const;

  std::vector<Edge> edges_;
  std::vector<Eigen::Vector2d> points_m_;
};

}  // namespace cornerstone
