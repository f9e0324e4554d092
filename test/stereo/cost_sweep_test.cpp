#include "cornerstone/stereo/cost_sweep.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace cornerstone {
namespace {

Workers one_thread(1);

struct Scene {
  cv::Mat1b reference = cv::Mat1b(40, 61), secondary = cv::Mat1b(40, 61);
  GradientFeatures reference_features, secondary_features;
  explicit Scene(int seed) {
    cv::RNG random(static_cast<std::uint64_t>(seed));
    random.fill(reference, cv::RNG::UNIFORM, 0, 255);
    random.fill(secondary, cv::RNG::UNIFORM, 0, 255);
    reference_features.compute(reference, one_thread);
    secondary_features.compute(secondary, one_thread);
  }
};

// Feature differences of one camera, counted twice; that of disparity 0 where it does not see the pixel.
int pairCost(const Scene& scene, const SecondaryView& view, cv::Point at, int disparity_px) {
  const cv::Point seen = at + view.offsetAt(disparity_px);
  if (!cv::Rect({0, 0}, scene.reference.size()).contains(seen))
    return 2 * scene.reference_features.costAt(at, scene.secondary_features, at);
  return 2 * scene.reference_features.costAt(at, scene.secondary_features, seen);
}

TEST(CostSweep, KeepsTheWindowCostsOfItsWinners) {
  const Scene scene(1);
  // Right, left, top, bottom, and baselines of other lengths.
  for (const cv::Point2d shift :
       {cv::Point2d(-1, 0), {1, 0}, {0, 1}, {0, -1}, {-0.5, 0}, {-2, 0}, {0, 0.75}}) {
    SweepInput input;
    input.reference_image = &scene.reference;
    input.reference = &scene.reference_features;
    input.max_disparity_px = 20;
    input.window_px = 3;
    input.view_count = 1;
    input.views[0].prepare(scene.secondary_features, shift, CostSweep::disparitiesFor(20));
    CostSweep sweep;
    const Winners& winners = sweep.run(input, one_thread);
    int checked = 0;
    for (int y = 1; y < 39; ++y) {
      for (int x = 1; x < 60; ++x) {
        const int d = winners.disparity_px(y, x);
        if (winners.cost(y, x) == Winners::kNoCost || d == CostSweep::disparitiesFor(20)) continue;
        int before = 0, here = 0, after = 0;
        for (const cv::Point by :
             {cv::Point(-1, -1), {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}) {
          before += pairCost(scene, input.views[0], cv::Point(x, y) + by, d - 1);
          here += pairCost(scene, input.views[0], cv::Point(x, y) + by, d);
          after += pairCost(scene, input.views[0], cv::Point(x, y) + by, d + 1);
        }
        ASSERT_EQ(winners.cost_before(y, x), before) << shift << x << ' ' << y << ' ' << d;
        ASSERT_EQ(winners.cost(y, x), here) << shift << x << ' ' << y << ' ' << d;
        ASSERT_EQ(winners.cost_after(y, x), after) << shift << x << ' ' << y << ' ' << d;
        ASSERT_EQ(winners.own_cost(y, x), pairCost(scene, input.views[0], {x, y}, d));
        ++checked;
      }
    }
    EXPECT_GT(checked, 300) << shift;
  }
}

}  // namespace
}  // namespace cornerstone
