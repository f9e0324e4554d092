#include "cornerstone/stereo/gradient_features.h"

#include <cstdlib>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

#include "cornerstone/stereo/sweep_kernels.h"

namespace cornerstone {
namespace {

constexpr int kReach_px = 2;
// Noise of a difference in grey levels: good cameras have 1 to 2 a pixel, small ones in poor light 4;
// smoothing halves it. Half and double of both change the share of wrong answers on noisy images by a tenth.
constexpr float kNoise_grey = 4, kSmoothNoise_grey = 2;
constexpr int kVector_px = 64;

// The image itself in a plane with a border for differences and smoothing, and room for whole vectors.
cv::Mat1b within(cv::Mat1b& plane, cv::Size size, int border_px) {
  const cv::Size wanted(size.width + 2 * border_px + kVector_px, size.height + 2 * border_px);
  if (plane.size() != wanted) {
    plane.create(wanted);
    plane.setTo(0);
  }
  return plane(cv::Rect({border_px, border_px}, size));
}

struct Differences {
  int reach_px = 1;
  float noise_grey = 1;
};

// Right and down differences in a row of an image within a border.
void squashDifferences(const cv::Mat1b& image, int row, const Differences& of, cv::Mat1b* channels) {
  const SweepKernels& kernels = sweepKernels();
  const std::ptrdiff_t down = of.reach_px * static_cast<std::ptrdiff_t>(image.step);
  const std::uint8_t* middle = image[row];
  kernels.squash({middle + of.reach_px, middle - of.reach_px, of.noise_grey, image.cols}, channels[0][row]);
  kernels.squash({middle + down, middle - down, of.noise_grey, image.cols}, channels[1][row]);
}

}  // namespace

void GradientFeatures::compute(const cv::Mat1b& image, Workers& workers) {
  constexpr int kSmoothBorder_px = kReach_px, kBorder_px = kReach_px + 1;  // smoothing takes one
  const cv::Mat1b framed = within(padded_, image.size(), kBorder_px);
  smooth_ = within(padded_smooth_, image.size(), kSmoothBorder_px);
  cv::Mat1b with_border = padded_.colRange(0, image.cols + 2 * kBorder_px);
  cv::copyMakeBorder(image, with_border, kBorder_px, kBorder_px, kBorder_px, kBorder_px,
                     cv::BORDER_REFLECT_101);
  workers.share(image.rows + 2 * kSmoothBorder_px, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* rows[] = {padded_[y] + 1, padded_[y + 1] + 1, padded_[y + 2] + 1};
      sweepKernels().smooth(rows, image.cols + 2 * kSmoothBorder_px, padded_smooth_[y]);
    }
  });
  for (std::size_t c = 0; c < kChannels; ++c) channels_[c] = within(planes_[c], image.size(), 0);
  together_.create(image.rows + 1, image.cols);
  workers.share(image.rows, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      squashDifferences(framed, y, {1, kNoise_grey}, &channels_[0]);
      squashDifferences(smooth_, y, {2, kSmoothNoise_grey}, &channels_[2]);
    }
    std::array<cv::Mat, kChannels> channels;
    for (std::size_t c = 0; c < kChannels; ++c) channels[c] = channels_[c].rowRange(begin, end);
    cv::Mat pixels = together_.rowRange(begin, end);
    cv::merge(channels.data(), kChannels, pixels);
  });
}

int GradientFeatures::costAt(cv::Point here, const GradientFeatures& other, cv::Point there) const {
  int cost = 0;
  for (std::size_t c = 0; c < kChannels; ++c)
    cost += std::abs(channels_[c](here) - other.channels_[c](there));
  return cost;
}

int GradientFeatures::costAround(cv::Point here, const GradientFeatures& other, cv::Point there) const {
  // Four pixels of four bytes make a vector; the fourth does not count.
  const cv::v_uint8x16 three = cv::v_reinterpret_as_u8(cv::v_uint32x4(~0u, ~0u, ~0u, 0));
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(together_.step);
  const auto* a = together_.ptr<std::uint8_t>(here.y - 1, here.x - 1);
  const auto* b = other.together_.ptr<std::uint8_t>(there.y - 1, there.x - 1);
  const auto ofRow = [&](int row) {
    return cv::v_absdiff(cv::v_load(a + row * step), cv::v_load(b + row * step));
  };
  static_assert(3 * kLargest < 256);
  return static_cast<int>(cv::v_reduce_sum((ofRow(0) + ofRow(1) + ofRow(2)) & three));
}

void GradientFeatures::costsOfRow(int row, const GradientFeatures& other, cv::Point offset,
                                  std::uint8_t* costs) const {
  static_assert(kChannels == 4);
  const cv::Rect image({0, 0}, size()), seen = image & (image - offset);
  if (row < seen.y || row >= seen.br().y) return;
  std::array<const std::uint8_t*, kChannels> a{}, b{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    a[c] = channels_[c][row];
    b[c] = other.channels_[c][row + offset.y] + offset.x;
  }
  const auto difference = [](const std::uint8_t* one, const std::uint8_t* another) {
    return cv::v_absdiff(cv::v_load(one), cv::v_load(another));
  };
  constexpr int kLanes = cv::v_uint8x16::nlanes;
  int x = seen.x;
  for (; x + kLanes <= seen.br().x; x += kLanes)
    cv::v_store(costs + x, difference(a[0] + x, b[0] + x) + difference(a[1] + x, b[1] + x) +
                               difference(a[2] + x, b[2] + x) + difference(a[3] + x, b[3] + x));
  for (; x < seen.br().x; ++x)
    costs[x] = static_cast<std::uint8_t>(std::abs(a[0][x] - b[0][x]) + std::abs(a[1][x] - b[1][x]) +
                                         std::abs(a[2][x] - b[2][x]) + std::abs(a[3][x] - b[3][x]));
}

}  // namespace cornerstone
