#include "cornerstone/base/grid_geometry.h"

#include <gtest/gtest.h>

namespace cornerstone {
namespace {

const GridGeometry kGrid{0.5, -1, 2, 4, 3};  // x from -1 to 1 m, y from 2 to 3.5 m

TEST(GridGeometry, FindsTheCellOfAPoint) {
  EXPECT_EQ(kGrid.cellAt({-1, 2}), (Cell{0, 0}));
  EXPECT_EQ(kGrid.cellAt({0.9, 3.4}), (Cell{3, 2}));
  EXPECT_FALSE(kGrid.contains(kGrid.cellAt({-1.01, 2})));
  EXPECT_FALSE(kGrid.contains(kGrid.cellAt({0, 3.51})));
}

TEST(GridGeometry, CentresAndContinuousCoordinatesAgree) {
  const Eigen::Vector2d centre = kGrid.centreOf({1, 2});
  EXPECT_NEAR(centre.x(), -0.25, 1e-12);
  EXPECT_NEAR(centre.y(), 3.25, 1e-12);
  const Eigen::Vector2d cells = kGrid.toCells({0, 3.25});  // the border between columns 1 and 2
  EXPECT_NEAR(cells.x(), 1.5, 1e-12);
  EXPECT_NEAR(cells.y(), 2, 1e-12);
}

TEST(GridGeometry, ImageRowFlips) {
  EXPECT_EQ(kGrid.imageRow(0), 2);
  EXPECT_EQ(kGrid.imageRow(kGrid.imageRow(1)), 1);
}

}  // namespace
}  // namespace cornerstone
