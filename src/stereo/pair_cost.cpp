#include "cornerstone/stereo/pair_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>

#include "cornerstone/stereo/census.h"

namespace cornerstone {
namespace {

constexpr int kLanes = 16;

// Number of set bits of each half byte.
inline cv::v_uint8x16 halfByteCounts(const cv::v_uint8x16& bits) {
  const cv::v_uint8x16 odd = cv::v_setall_u8(0x55), two = cv::v_setall_u8(0x33);
  const auto shifted = [](const cv::v_uint8x16& v, auto by) {
    return cv::v_reinterpret_as_u8(cv::v_shr<decltype(by)::value>(cv::v_reinterpret_as_u16(v)));
  };
  const cv::v_uint8x16 pairs = cv::v_sub_wrap(bits, shifted(bits, std::integral_constant<int, 1>()) & odd);
  return cv::v_add_wrap(pairs & two, shifted(pairs, std::integral_constant<int, 2>()) & two);
}

inline cv::v_uint8x16 byteCounts(const cv::v_uint8x16& half_bytes) {
  const cv::v_uint8x16 low = cv::v_setall_u8(0x0f);
  const cv::v_uint8x16 high = cv::v_reinterpret_as_u8(cv::v_shr<4>(cv::v_reinterpret_as_u16(half_bytes)));
  return cv::v_add_wrap(half_bytes & low, high & low);
}

inline cv::v_uint8x16 costOfTwo(const std::uint8_t* r, const std::uint8_t* a, const std::uint8_t* b) {
  const cv::v_uint8x16 reference = cv::v_load(r);
  // At most 4 + 4 = 8 in a half byte, so both cameras share the last step.
  return byteCounts(
      cv::v_add_wrap(halfByteCounts(reference ^ cv::v_load(a)), halfByteCounts(reference ^ cv::v_load(b))));
}

// Runs over a part of the row in whole vectors; the last one overlaps, a part shorter than a vector goes via
// a copy.
void costPart(const std::uint8_t* reference, const std::uint8_t* a, const std::uint8_t* b, cv::Range part,
              std::uint8_t* costs) {
  if (part.size() >= kLanes) {
    for (int x = part.start; x < part.end; x += kLanes) {
      const int at = std::min(x, part.end - kLanes);
      cv::v_store(costs + at, costOfTwo(reference + at, a + at, b + at));
    }
    return;
  }
  std::array<std::uint8_t, kLanes> r{}, s{}, t{}, out{};
  const auto count = static_cast<std::size_t>(part.size());
  std::memcpy(r.data(), reference + part.start, count);
  std::memcpy(s.data(), a + part.start, count);
  std::memcpy(t.data(), b + part.start, count);
  cv::v_store(out.data(), costOfTwo(r.data(), s.data(), t.data()));
  std::memcpy(costs + part.start, out.data(), count);
}

}  // namespace

SeenRow seenRow(const SecondaryView& view, int row, int disparity_px) {
  const cv::Point offset = view.offsetAt(disparity_px);
  const int dx = offset.x, dy = offset.y;
  const cv::Mat1b& census = view.census();
  if (row + dy < 0 || row + dy >= census.rows || std::abs(dx) >= census.cols) return {};
  return {std::max(0, -dx), census.cols - std::max(0, dx), census[row + dy] + dx};
}

void pairCostRow(const std::uint8_t* reference, const SeenRow& first, const SeenRow& second,
                 cv::Range columns, std::uint8_t* costs) {
  std::array<int, 6> cuts{columns.start, first.begin, first.end, second.begin, second.end, columns.end};
  for (int& cut : cuts) cut = std::clamp(cut, columns.start, columns.end);
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const cv::Range part(cuts[i], cuts[i + 1]);
    if (part.empty()) continue;
    const bool in_first = part.start >= first.begin && part.end <= first.end;
    const bool in_second = part.start >= second.begin && part.end <= second.end;
    if (!in_first && !in_second)
      std::memset(costs + part.start, kCensusBits, static_cast<std::size_t>(part.size()));
    else
      costPart(reference, in_first ? first.census : second.census, in_second ? second.census : first.census,
               part, costs);
  }
}

}  // namespace cornerstone
