#include "cornerstone/registration/line_cost.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cornerstone {
namespace {

const std::vector<LinePair> kPairs{{{1, 0}, {0, 3}, {0, 1}, 1}, {{0, 2}, {4, 0}, {0.6, 0.8}, 0.5}};

TEST(LineCost, ResidualsAreWeightedDistancesToLines) {
  const LineCost cost(kPairs);
  const Eigen::Vector3d x(5, 1, M_PI / 2);  // (1,0) goes to (5,2), (0,2) to (3,1)
  const double* block = x.data();
  std::vector<double> residuals(2, std::numeric_limits<double>::quiet_NaN());
  ASSERT_TRUE(cost.Evaluate(&block, residuals.data(), nullptr));
  EXPECT_NEAR(residuals[0], -1, 1e-12);
  EXPECT_NEAR(residuals[1], 0.5 * (0.6 * -1 + 0.8 * 1), 1e-12);
}

TEST(LineCost, DerivativesAreRight) {
  LineCost cost(kPairs);
  const std::vector<const ceres::Manifold*> no_manifolds{nullptr};
  ceres::GradientChecker checker(&cost, &no_manifolds, ceres::NumericDiffOptions{});
  const Eigen::Vector3d x(0.3, -2, 2.2);
  const double* block = x.data();
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(&block, 1e-7, &results)) << results.error_log;
}

}  // namespace
}  // namespace cornerstone
