#include "cornerstone/stereo/gradient_features.h"

#include <cmath>
#include <cstdlib>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace cornerstone {
namespace {

constexpr int kReach_px = 2;
// Noise of a difference in grey levels: good cameras have 1 to 2 a pixel, small ones in poor light 4;
// smoothing halves it. Half and double of both change the share of wrong answers on noisy images by a tenth.
constexpr double kNoise_grey = 4, kSmoothNoise_grey = 2;

class Squash {
 public:
  explicit Squash(double noise_grey) {
    for (int g = -255; g <= 255; ++g)
      features_[static_cast<std::size_t>(g + 255)] = static_cast<std::uint8_t>(
          std::lround(GradientFeatures::kLargest / 2.0 * (1 + g / (std::abs(g) + noise_grey))));
  }
  std::uint8_t operator()(int ahead, int behind) const {
    return features_[static_cast<std::size_t>(ahead - behind + 255)];
  }

 private:
  std::array<std::uint8_t, 511> features_{};
};

// Right and down differences of an image with a border of kReach_px, at `reach_px`.
void squashDifferences(const cv::Mat1b& padded, int reach_px, const Squash& squash, cv::Mat1b* channels) {
  for (int y = 0; y < channels[0].rows; ++y) {
    const std::uint8_t* middle = padded[y + kReach_px] + kReach_px;
    const std::uint8_t *above = padded[y + kReach_px - reach_px] + kReach_px,
                       *below = padded[y + kReach_px + reach_px] + kReach_px;
    std::uint8_t *right = channels[0][y], *down = channels[1][y];
    for (int x = 0; x < channels[0].cols; ++x) {
      right[x] = squash(middle[x + reach_px], middle[x - reach_px]);
      down[x] = squash(below[x], above[x]);
    }
  }
}

}  // namespace

void GradientFeatures::compute(const cv::Mat1b& image) {
  static const Squash squash(kNoise_grey), squash_smooth(kSmoothNoise_grey);
  cv::GaussianBlur(image, smooth_, {3, 3}, 0, 0, cv::BORDER_REFLECT_101);  // weights 1 2 1
  cv::copyMakeBorder(image, padded_, kReach_px, kReach_px, kReach_px, kReach_px, cv::BORDER_REFLECT_101);
  cv::copyMakeBorder(smooth_, padded_smooth_, kReach_px, kReach_px, kReach_px, kReach_px,
                     cv::BORDER_REFLECT_101);
  for (cv::Mat1b& channel : channels_) channel.create(image.size());
  squashDifferences(padded_, 1, squash, &channels_[0]);
  squashDifferences(padded_smooth_, 2, squash_smooth, &channels_[2]);
  together_.create(image.rows + 1, image.cols);
  cv::Mat4b pixels = together_.rowRange(0, image.rows);
  cv::merge(channels_.data(), kChannels, pixels);
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
  int cost = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    const auto* a = together_.ptr<std::uint8_t>(here.y + dy, here.x - 1);
    const auto* b = other.together_.ptr<std::uint8_t>(there.y + dy, there.x - 1);
    cost += static_cast<int>(cv::v_reduce_sad(cv::v_load(a) & three, cv::v_load(b) & three));
  }
  return cost;
}

void GradientFeatures::costs(const GradientFeatures& other, cv::Point offset, cv::Mat1b& costs) const {
  static_assert(kChannels == 4);
  const cv::Rect image({0, 0}, size()), seen = image & (image - offset);
  for (int y = seen.y; y < seen.br().y; ++y) {
    std::array<const std::uint8_t*, kChannels> a{}, b{};
    for (std::size_t c = 0; c < kChannels; ++c) {
      a[c] = channels_[c][y];
      b[c] = other.channels_[c][y + offset.y] + offset.x;
    }
    std::uint8_t* out = costs[y];
    for (int x = seen.x; x < seen.br().x; ++x)
      out[x] = static_cast<std::uint8_t>(std::abs(a[0][x] - b[0][x]) + std::abs(a[1][x] - b[1][x]) +
                                         std::abs(a[2][x] - b[2][x]) + std::abs(a[3][x] - b[3][x]));
  }
}

}  // namespace cornerstone
