#include "cornerstone/landmarks/corner_cost.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace cornerstone {
namespace {

// Edges along the lower border of row 10, cells of 1 m: the field is |row - 10| in the middle of the map.
DistanceField wallField() {
  std::vector<EdgePoint> edges;
  for (int col = 0; col < 40; ++col) edges.push_back({{col + 0.5, 10.2}, {0, 1}});
  return DistanceField(edges, GridGeometry{1, 0, 0, 40, 40});
}

TEST(DistanceField, IsTheDistanceInCellsAndItsSlope) {
  const DistanceField field = wallField();
  Eigen::Vector2d gradient;
  EXPECT_NEAR(field.at({20, 10}), 0, 1e-6);
  EXPECT_NEAR(field.at({20.3, 13.25}, gradient), 3.25, 1e-5);
  EXPECT_NEAR(gradient.x(), 0, 1e-5);
  EXPECT_NEAR(gradient.y(), 1, 1e-5);
  EXPECT_NEAR(field.at({20.3, 7.5}, gradient), 2.5, 1e-5);
  EXPECT_NEAR(gradient.y(), -1, 1e-5);
}

TEST(DistanceField, GoesOnBeyondTheBorder) {
  Eigen::Vector2d gradient;
  EXPECT_NEAR(wallField().at({20.3, -8}, gradient), kReachCells + 1, 1e-4);
  EXPECT_NEAR(gradient.norm(), 0, 1e-9);
}

TEST(CornerCost, ResidualsAreDistancesAndStabiliser) {
  const DistanceField field = wallField();
  CornerCost cost(field, 4, 3, 0.1);
  cost.setPrevious({20, 10, 0});
  const Eigen::Vector3d x(20, 12, 0);
  const double* block = x.data();
  std::vector<double> residuals(8, std::numeric_limits<double>::quiet_NaN());
  ASSERT_EQ(cost.num_residuals(), 8);
  ASSERT_TRUE(cost.Evaluate(&block, residuals.data(), nullptr));
  const std::vector<double> expected{2, 2, 2,   4,
                                     6, 0, 0.2, 0};  // one arm along x, the other up; 0.1 * (x - x_prev)
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(residuals[i], expected[i], 1e-5) << i;
}

TEST(CornerCost, DerivativesAreRight) {
  const DistanceField field = wallField();
  CornerCost cost(field, 4, 5, 0.1);
  cost.setPrevious({19, 12, 20});
  const std::vector<const ceres::Manifold*> no_manifolds{nullptr};
  ceres::GradientChecker checker(&cost, &no_manifolds, ceres::NumericDiffOptions{});
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d(20.37, 13.41, 17.3), Eigen::Vector3d(11.63, 14.29, 201.7)}) {
    const double* block = x.data();
    ceres::GradientChecker::ProbeResults results;
    EXPECT_TRUE(checker.Probe(&block, 1e-4, &results)) << results.error_log;
  }
}

}  // namespace
}  // namespace cornerstone
