#include "cornerstone/mapping/bearing_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cornerstone {
namespace {

std::vector<double> evenly(int count, double first_rad, double last_rad) {
  std::vector<double> bearings_rad;
  for (int i = 0; i < count; ++i)
    bearings_rad.push_back(first_rad + i * (last_rad - first_rad) / (count - 1));
  return bearings_rad;
}

// By arc tangents, one beam after the other.
std::optional<std::size_t> plainNearest(const std::vector<double>& bearings_rad, double bearing_rad) {
  if (bearing_rad < bearings_rad.front() || bearing_rad > bearings_rad.back()) return std::nullopt;
  std::size_t best = 0;
  for (std::size_t i = 1; i < bearings_rad.size(); ++i)
    if (std::abs(bearings_rad[i] - bearing_rad) <= std::abs(bearings_rad[best] - bearing_rad)) best = i;
  return best;
}

TEST(BearingIndex, FindsTheNearestBeamFromAnyOtherOn) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place_m(-5, 5);
  for (const auto& bearings_rad :
       {evenly(160, -0.6, 0.6), evenly(361, -M_PI + 1e-9, M_PI), evenly(181, -M_PI / 2, M_PI / 2),
        std::vector<double>{-1, -0.9, 0.1, 2, 3}, std::vector<double>{0.5}}) {
    const BearingIndex index(bearings_rad);
    std::uniform_int_distribution<std::size_t> beam(0, bearings_rad.size() + 1);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector2d at_m(place_m(random), place_m(random));
      EXPECT_EQ(index.nearest(at_m, beam(random)),
                plainNearest(bearings_rad, std::atan2(at_m.y(), at_m.x())));
    }
  }
}

TEST(BearingIndex, FindsNothingAmongNoBeams) {
  EXPECT_FALSE(BearingIndex(std::vector<double>{}).nearest({1, 0}, 0));
  EXPECT_FALSE(BearingIndex().nearest({1, 0}, 0));
}

}  // namespace
}  // namespace cornerstone
