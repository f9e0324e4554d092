#include "cornerstone/simulation/true_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cornerstone {
namespace {

Solid block(double x_m, double y_m, double size_m, double z_min_m, double z_max_m) {
  return boxSolid({{x_m, y_m}, 0, {size_m, size_m, z_max_m - z_min_m}, z_min_m, Material::kPaint});
}

// The highest and lowest x of what is seen.
std::pair<double, double> seenX(const TrueSurfaces& surfaces, const Sight& sight) {
  double low = 1e9, high = -1e9;
  for (const std::size_t i : surfaces.visibleFrom({0, 0, 0}, sight)) {
    low = std::min(low, surfaces.points()[i].x());
    high = std::max(high, surfaces.points()[i].x());
  }
  return {low, high};
}

TEST(TrueSurfaces, OnlyTheNearSideOfABlockIsSeen) {
  const TrueSurfaces surfaces({block(2, 0, 1, 0, 1)});
  const auto [low, high] = seenX(surfaces, {M_PI / 2, 5});
  EXPECT_NEAR(low, 1.5, 1e-9);
  EXPECT_NEAR(high, 1.5, 1e-9);
  // 1 m of it, points 0.02 m apart; a ray may miss the outermost.
  EXPECT_NEAR(double(surfaces.visibleFrom({0, 0, 0}, {M_PI / 2, 5}).size()), 51, 2);
  EXPECT_TRUE(surfaces.visibleFrom({0, 0, M_PI}, {M_PI / 2, 5}).empty());
  EXPECT_TRUE(surfaces.visibleFrom({0, 0, 0}, {M_PI / 2, 1.4}).empty());
}

TEST(TrueSurfaces, HeightsOutsideTheBandNeitherCountNorHide) {
  const Solid behind = block(4, 0, 1, 0, 2);
  for (const Solid& before : {block(2, 0, 1, 0, 0.1), block(2, 0, 1, 1.6, 2)}) {
    const TrueSurfaces surfaces({before, behind});
    EXPECT_NEAR(seenX(surfaces, {0.1, 5}).first, 3.5, 1e-9);
  }
  const TrueSurfaces low_but_in_band({block(2, 0, 1, 0, 0.3), behind});
  EXPECT_NEAR(seenX(low_but_in_band, {0.1, 5}).second, 1.5, 1e-9);
}

TEST(TrueSurfaces, DistanceToTheNearestOutline) {
  const TrueSurfaces surfaces({block(2, 0, 1, 0, 1)});
  EXPECT_NEAR(surfaces.distanceTo({0, 0}), 1.5, 1e-12);
  EXPECT_NEAR(surfaces.distanceTo({1.5, 0.2}), 0, 1e-12);
  EXPECT_NEAR(surfaces.distanceTo({0.5, 1.5}), std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(std::isinf(TrueSurfaces({}).distanceTo({0, 0})));
}

}  // namespace
}  // namespace cornerstone
