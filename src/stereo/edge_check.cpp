#include "cornerstone/stereo/edge_check.h"

#include <array>
#include <cstdlib>

#include "cornerstone/stereo/census.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {
namespace {

constexpr int kStep_px = 1;  // neighbours on one surface differ by no more

constexpr std::array<std::uint8_t, 256> bitCounts() {
  std::array<std::uint8_t, 256> counts{};
  for (std::size_t i = 1; i < counts.size(); ++i)
    counts[i] = static_cast<std::uint8_t>(counts[i / 2] + i % 2);
  return counts;
}
constexpr std::array<std::uint8_t, 256> kBitCounts = bitCounts();

// Mean over the cameras that see all of the 3 x 3 px; that of chance if none does.
double costAround(const SweepInput& input, cv::Point at, int disparity_px) {
  const cv::Mat1b& reference = *input.reference_census;
  const cv::Rect inner(1, 1, reference.cols - 2, reference.rows - 2);
  int sum = 0, cameras = 0;
  for (const SecondaryView& view : input.views) {
    const cv::Point seen = at + view.offsetAt(disparity_px);
    if (!inner.contains(at) || !inner.contains(seen)) continue;
    ++cameras;
    for (int dy = -1; dy <= 1; ++dy) {
      const std::uint8_t* r = reference[at.y + dy] + at.x;
      const std::uint8_t* s = view.census()[seen.y + dy] + seen.x;
      for (int dx = -1; dx <= 1; ++dx) sum += kBitCounts[static_cast<std::size_t>(r[dx] ^ s[dx])];
    }
  }
  return cameras > 0 ? static_cast<double>(sum) / cameras : 9 * kCensusBits / 2.0;
}

}  // namespace

bool EdgeCheck::standsOut(const Winners& winners, const SweepInput& input, cv::Point at,
                          double smallest_cost_ratio) const {
  const int reach_px = input.window_px / 2 + 1;
  const int own_px = winners.disparity_px(at);
  double own_cost = -1;
  for (const cv::Point step : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
    const cv::Point other = at + step * reach_px;
    if (other.x < 0 || other.y < 0 || other.x >= before_.cols || other.y >= before_.rows) continue;
    const int other_px = winners.disparity_px(other);
    if (std::abs(other_px - own_px) <= kStep_px || before_(other) != 0) continue;
    if (own_cost < 0) own_cost = costAround(input, at, own_px);
    if (costAround(input, at, other_px) < smallest_cost_ratio * own_cost) return false;
  }
  return true;
}

void EdgeCheck::check(const Winners& winners, const SweepInput& input, double smallest_cost_ratio,
                      cv::Mat1b& rejection) {
  rejection.copyTo(before_);
  for (int y = 0; y < rejection.rows; ++y)
    for (int x = 0; x < rejection.cols; ++x)
      if (before_(y, x) == 0 && !standsOut(winners, input, {x, y}, smallest_cost_ratio))
        rejection(y, x) = static_cast<std::uint8_t>(Rejection::kUniqueness);
}

}  // namespace cornerstone
