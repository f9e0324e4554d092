// Odometry that jumps far away must neither exhaust the memory nor spoil the map.
#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/mapper.h"

namespace cornerstone {
namespace {

RangeScan wallAhead() {
  RangeScan scan;
  for (int i = -20; i <= 20; ++i) {
    Beam beam;
    beam.bearing_rad = i * 0.02;
    beam.width_rad = 0.02;
    beam.hit = true;
    beam.range_m = 2 / std::cos(beam.bearing_rad);
    beam.sigma_m = 0.02;
    beam.near_m = beam.range_m - 0.04;
    beam.far_m = beam.range_m + 0.04;
    scan.beams.push_back(beam);
  }
  return scan;
}

TEST(OdometryAstray, IsRefusedAndTheMapGoesOnWhenItComesBack) {
  Mapper mapper({});
  mapper.update(wallAhead(), {});
  const GridGeometry before = mapper.grid().geometry();
  for (const double far_m : {1e4, 1e5, 1e9, 1e30, -1e9})
    EXPECT_THROW(mapper.update(wallAhead(), {far_m, 0, 0}), InputError) << far_m;
  mapper.update(wallAhead(), {0.01, 0, 0});
  EXPECT_EQ(mapper.grid().geometry().cols, before.cols);
  EXPECT_NEAR(mapper.pose().map_from_base.x_m, 0.01, 0.02);
}

TEST(OdometryAstray, AMapTooLargeToHoldIsRefused) {
  OccupancyGrid grid({});
  grid.insert(wallAhead(), {});
  EXPECT_THROW(grid.insert(wallAhead(), {2000, 2000, 0}), InputError);
  EXPECT_THROW(grid.insert(wallAhead(), {1e7, 0, 0}), InputError);
  grid.insert(wallAhead(), {100, 100, 0});
  EXPECT_GT(grid.geometry().cols, 1900);
}

}  // namespace
}  // namespace cornerstone
