#include "cornerstone/stereo/census.h"

#include <array>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace cornerstone {
namespace {

constexpr int kReach_px = 2;
constexpr std::size_t kPairs = 4;
// A bit is set when the pixel at +offset is brighter than the one at -offset.
const std::array<cv::Point, kPairs> kDirections{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};

// Bits first_bit .. first_bit + 3 of a row: the four directions at `reach_px` pixels.
void censusRow(const cv::Mat1b& padded, int y, int reach_px, unsigned first_bit, cv::Range columns,
               std::uint8_t* out) {
  std::array<const std::uint8_t*, kPairs> ahead{}, behind{};
  for (std::size_t i = 0; i < kPairs; ++i) {
    const cv::Point o = kDirections[i] * reach_px;
    ahead[i] = padded[y + kReach_px + o.y] + kReach_px + o.x;
    behind[i] = padded[y + kReach_px - o.y] + kReach_px - o.x;
  }
  int x = columns.start;
  for (; x + 16 <= columns.end; x += 16) {
    cv::v_uint8x16 bits = cv::v_load(out + x);
    for (std::size_t i = 0; i < kPairs; ++i) {
      const cv::v_uint8x16 rises = cv::v_load(ahead[i] + x) > cv::v_load(behind[i] + x);
      bits = bits | (rises & cv::v_setall_u8(static_cast<std::uint8_t>(1u << (first_bit + i))));
    }
    cv::v_store(out + x, bits);
  }
  for (; x < columns.end; ++x)
    for (std::size_t i = 0; i < kPairs; ++i)
      if (ahead[i][x] > behind[i][x]) out[x] = static_cast<std::uint8_t>(out[x] | (1u << (first_bit + i)));
}

}  // namespace

void CensusTransform::apply(const cv::Mat1b& image, cv::Mat1b& census) {
  cv::GaussianBlur(image, smooth_, {3, 3}, 0, 0, cv::BORDER_REFLECT_101);  // weights 1 2 1
  cv::copyMakeBorder(image, padded_, kReach_px, kReach_px, kReach_px, kReach_px, cv::BORDER_REFLECT_101);
  cv::copyMakeBorder(smooth_, padded_smooth_, kReach_px, kReach_px, kReach_px, kReach_px,
                     cv::BORDER_REFLECT_101);
  census.create(image.size());
  census.setTo(0);
  for (int y = 0; y < image.rows; ++y) {
    censusRow(padded_, y, 1, 0, {0, image.cols}, census[y]);
    censusRow(padded_smooth_, y, 2, kPairs, {0, image.cols}, census[y]);
  }
}

}  // namespace cornerstone
