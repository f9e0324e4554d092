#include "cornerstone/stereo/census.h"

#include <array>
#include <opencv2/core/hal/intrin.hpp>

namespace cornerstone {
namespace {

constexpr int kReach_px = 2;
// A bit is set when the pixel at +offset is brighter than the one at -offset.
const std::array<cv::Point, kCensusBits> kOffsets_px{
    {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}, {2, 1}, {-1, 2}}};

void censusRow(const cv::Mat1b& padded, int y, std::uint8_t* out, int width) {
  std::array<const std::uint8_t*, kCensusBits> ahead{}, behind{};
  for (std::size_t i = 0; i < kOffsets_px.size(); ++i) {
    const cv::Point o = kOffsets_px[i];
    ahead[i] = padded[y + kReach_px + o.y] + kReach_px + o.x;
    behind[i] = padded[y + kReach_px - o.y] + kReach_px - o.x;
  }
  int x = 0;
  for (; x + 16 <= width; x += 16) {
    cv::v_uint8x16 bits = cv::v_setzero_u8();
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      const cv::v_uint8x16 rises = cv::v_load(ahead[i] + x) > cv::v_load(behind[i] + x);
      bits = bits | (rises & cv::v_setall_u8(static_cast<std::uint8_t>(1u << i)));
    }
    cv::v_store(out + x, bits);
  }
  for (; x < width; ++x) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < ahead.size(); ++i) bits |= (ahead[i][x] > behind[i][x] ? 1u : 0u) << i;
    out[x] = static_cast<std::uint8_t>(bits);
  }
}

}  // namespace

void CensusTransform::apply(const cv::Mat1b& image, cv::Mat1b& census) {
  cv::copyMakeBorder(image, padded_, kReach_px, kReach_px, kReach_px, kReach_px, cv::BORDER_REFLECT_101);
  census.create(image.size());
  for (int y = 0; y < image.rows; ++y) censusRow(padded_, y, census[y], image.cols);
}

}  // namespace cornerstone
