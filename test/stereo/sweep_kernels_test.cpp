// The paths of the search against Hirschmueller's equation, number by number, for every set of kernels.
#include "cornerstone/stereo/sweep_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <tuple>
#include <vector>

namespace cornerstone {
namespace {

constexpr int kWidth = 23, kDisparities = 64, kStride = kDisparities + 2, kRoom = 64;
constexpr int kSlope = 20;

using Costs = std::vector<int>;  // of one pixel

Costs step(const Costs& before, const std::uint8_t* costs, int jump) {
  const int lowest = *std::min_element(before.begin(), before.end());
  Costs here;
  for (int i = 0; i < kDisparities; ++i) {
    const auto at = [&](int k) {
      return k < 0 || k >= kDisparities ? 255 : before[static_cast<std::size_t>(k)];
    };
    const int best = std::min({at(i), at(i - 1) + kSlope, at(i + 1) + kSlope, lowest + jump});
    here.push_back(costs[i] + best - lowest);
  }
  return here;
}

struct Row {
  cv::Mat1b costs{cv::Size(kWidth * kDisparities + kRoom, 1)};
  cv::Mat1b jump_ahead{cv::Size(kWidth, 1)}, jump_down{cv::Size(kWidth, 1)};
  explicit Row(std::uint64_t seed) {
    cv::RNG random(seed);
    random.fill(costs, cv::RNG::UNIFORM, 0, 60);
    random.fill(jump_ahead, cv::RNG::UNIFORM, 20, 60);
    random.fill(jump_down, cv::RNG::UNIFORM, 20, 60);
  }
  const std::uint8_t* of(int x) const { return costs[0] + x * kDisparities; }
};

class Paths {
 public:
  Paths() {
    above_.setTo(0);
    for (int x = 0; x < kWidth; ++x) above_(0, x * kStride) = above_(0, (x + 1) * kStride - 1) = 255;
    lowest_.setTo(0);
  }
  PathRow rowFor(const Row& row) {
    PathRow paths;
    paths.costs = row.costs[0];
    paths.jump_ahead = row.jump_ahead[0];
    paths.jump_down = row.jump_down[0];
    paths.width = kWidth;
    paths.disparities = kDisparities;
    paths.slope_penalty = kSlope;
    paths.from_left = left_[0];
    paths.from_right = right_[0];
    paths.from_above = above_[0];
    paths.lowest_above = lowest_[0];
    paths.sums = sums_[0];
    paths.winners = {disparities_px[0], margins[0], leads[0]};
    return paths;
  }
  int left(int x, int i) const { return left_(0, x * kStride + 1 + i); }
  int right(int x, int i) const { return right_(0, x * kStride + 1 + i); }
  int above(int x, int i) const { return above_(0, x * kStride + 1 + i); }

  cv::Mat1s disparities_px{cv::Size(kWidth, 1)};
  cv::Mat1b margins{cv::Size(kWidth, 1)}, leads{cv::Size(kWidth, 1)};

 private:
  cv::Mat1b left_{cv::Size(kWidth * kStride + kRoom, 1)}, right_{cv::Size(kWidth * kStride + kRoom, 1)},
      above_{cv::Size(kWidth * kStride + kRoom, 1)}, lowest_{cv::Size(kWidth, 1)},
      sums_{cv::Size(kDisparities + kRoom, 1)};
};

class Kernels : public testing::TestWithParam<const SweepKernels*> {};

TEST_P(Kernels, FollowTheEquationAlongEachPath) {
  const SweepKernels& kernels = *GetParam();
  ASSERT_EQ(kDisparities % kernels.lanes, 0);
  Paths paths;
  std::vector<Costs> above(kWidth, Costs(kDisparities, 0));
  for (const std::uint64_t seed : {1u, 2u, 3u}) {  // rows from top to bottom
    const Row row(seed);
    const PathRow input = paths.rowFor(row);
    kernels.pathsAlong(input);
    kernels.pathDown(input);
    Costs left(kDisparities, 0), right(kDisparities, 0);
    for (int x = 0; x < kWidth; ++x) {
      left = step(left, row.of(x), x == 0 ? 0 : row.jump_ahead(0, x));
      above[static_cast<std::size_t>(x)] =
          step(above[static_cast<std::size_t>(x)], row.of(x), row.jump_down(0, x));
      for (int i = 0; i < kDisparities; ++i) {
        ASSERT_EQ(paths.left(x, i), left[static_cast<std::size_t>(i)]) << x << ' ' << i;
        ASSERT_EQ(paths.above(x, i), above[static_cast<std::size_t>(x)][static_cast<std::size_t>(i)])
            << x << ' ' << i;
      }
    }
    for (int x = kWidth - 1; x >= 0; --x) {
      right = step(right, row.of(x), x == kWidth - 1 ? 0 : row.jump_ahead(0, x + 1));
      for (int i = 0; i < kDisparities; ++i)
        ASSERT_EQ(paths.right(x, i), right[static_cast<std::size_t>(i)]) << x << ' ' << i;
    }
  }
}

TEST_P(Kernels, ChooseTheLowestSumAndTellItsMarginAndLead) {
  const SweepKernels& kernels = *GetParam();
  const Row row(4);
  Paths paths;
  const PathRow input = paths.rowFor(row);
  kernels.pathsAlong(input);
  kernels.pathDown(input);
  for (int x = 0; x < kWidth; ++x) {
    const auto sumAt = [&](int i) {
      return std::min(255, paths.left(x, i) + paths.right(x, i) + paths.above(x, i));
    };
    int best = 0;
    for (int i = 1; i < kDisparities; ++i) best = sumAt(i) < sumAt(best) ? i : best;
    int second = 255, rival = 255;
    for (int i = 0; i < kDisparities; ++i) {
      if (std::abs(i - best) <= 1) continue;
      second = std::min(second, sumAt(i));
      rival = std::min<int>(rival, row.of(x)[i]);
    }
    EXPECT_EQ(paths.disparities_px(0, x), best + 1) << x;
    EXPECT_EQ(paths.margins(0, x), second - sumAt(best)) << x;
    EXPECT_EQ(paths.leads(0, x), std::max(0, rival - row.of(x)[best])) << x;
  }
}

// The same number by number; rows of less than a vector and of parts of one.
TEST_P(Kernels, JudgeWinners) {
  for (const int width : {1, 7, 8, 15, 16, 17, 60}) {
    cv::RNG random(static_cast<std::uint64_t>(width));
    cv::Mat1s values(5, width);
    cv::Mat1b of_paths(2, width);
    random.fill(values, cv::RNG::UNIFORM, 0, 4000);
    random.fill(values.row(0), cv::RNG::UNIFORM, 1, 36);
    random.fill(of_paths, cv::RNG::UNIFORM, 0, 256);
    random.fill(of_paths.row(0).colRange(0, (width + 1) / 2), cv::RNG::UNIFORM, 0, 40);
    values(1, width / 3) = 32767;
    WinnerRow row;
    row.disparities_px = values[0];
    row.costs = values[1];
    row.before = values[2];
    row.after = values[3];
    row.chance = values[4];
    row.margins = of_paths[0];
    row.leads = of_paths[1];
    row.width = width;
    row.last_px = 32;
    row.smallest_margin = 18;
    row.least_cost = 245;
    row.no_cost = 32767;
    row.flat_gain = 0.4F;
    row.strong_product = 5.5F;
    std::tie(row.none, row.outside, row.texture, row.uniqueness, row.range) = std::tuple(0, 1, 2, 3, 6);
    std::tie(row.weak, row.strong, row.flat) = std::tuple(10, 11, 12);
    std::vector<std::uint8_t> verdicts(static_cast<std::size_t>(width) + 1, 99), evidence = verdicts;
    GetParam()->judge(row, verdicts.data(), evidence.data());
    EXPECT_EQ(verdicts.back(), 99);
    EXPECT_EQ(evidence.back(), 99);
    for (int x = 0; x < width; ++x) {
      const int d = values(0, x), cost = values(1, x), chance = values(4, x), margin = of_paths(0, x);
      const bool outward = (d <= 1 && values(2, x) < cost) || (d >= 32 && values(3, x) < cost) || d > 32;
      const bool flat = static_cast<float>(std::max(chance - cost, 0)) <= 0.4F * static_cast<float>(chance);
      const bool strong = static_cast<float>(margin * of_paths(1, x)) > 5.5F * static_cast<float>(cost + 245);
      const int verdict = cost == 32767 ? 1 : margin < 18 ? (flat ? 2 : 3) : outward ? 6 : 0;
      ASSERT_EQ(verdicts[static_cast<std::size_t>(x)], verdict) << width << ' ' << x;
      ASSERT_EQ(evidence[static_cast<std::size_t>(x)], strong ? 11 : flat ? 12 : 10) << width << ' ' << x;
    }
  }
}

// Nine fits, half a window apart, around a plane; those of another surface do not count, and where a
// neighbour is on another surface the plane is level.
TEST_P(Kernels, TellTheSpreadAroundAPlane) {
  constexpr int kReach = 2, kCols = 64, kFirst = 2 * kCols + 2;
  cv::Mat1f fits(5, kCols), means(5, kCols), sigmas(1, kCols), weights(1, kCols, 2.F);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < kCols; ++x) means(y, x) = fits(y, x) = 10 + 0.3F * static_cast<float>(x - 2 * y);
  const auto squareAt = [&](int x) {
    SigmaRow row;
    row.fits = fits[0] + kFirst;
    row.means = means[0] + kFirst;
    row.step = kCols;
    row.reach = kReach;
    row.width = kWidth;
    row.largest_step = 1;
    row.weights = weights[0];
    row.noise_variance = 0.02F;  // of weight 2: 0.01
    row.model_variance = 0.04F;
    row.sigmas = sigmas[0];
    GetParam()->sigma(row);
    return std::pow(sigmas(0, x - 2), 2) - 0.05;
  };
  EXPECT_NEAR(squareAt(9), 0, 1e-6);
  fits(0, 7) += 0.6F;
  fits(2, 11) -= 0.3F;
  fits(4, 9) += 1.5F;   // another surface
  fits(2, 10) += 0.5F;  // not among the nine
  EXPECT_NEAR(squareAt(9), (0.36F + 0.09F) / 8, 1e-4);
  means(2, 21) = 30;  // level from left to right: 0.6 off in the left and right columns
  EXPECT_NEAR(squareAt(19), 6 * 0.36F / 9, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(OfThisProcessor, Kernels, testing::Values(&plainSweepKernels(), &sweepKernels()));

}  // namespace
}  // namespace cornerstone
