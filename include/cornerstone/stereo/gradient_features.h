// What is compared of two images: brightness differences of opposite neighbours, squashed. Four channels a
// pixel: to the right and down at 1 px, and the same at 2 px in the image smoothed by 3 x 3, which sees weak
// and smooth texture through noise. Each is
//
//   feature = 15.5 (1 + g / (|g| + n)), rounded: 0 .. 31
//
// with g the difference and n the noise to expect of it in grey levels. Large differences count by their sign
// as in a census (Zabih and Woodfill, 1994), which neither a camera's gain nor its offset changes; those near
// the noise count by their size. The cost of two pixels is the sum of absolute differences.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "cornerstone/base/workers.h"

namespace cornerstone {

class GradientFeatures {
 public:
  static constexpr std::size_t kChannels = 4;
  static constexpr int kLargest = 31;

  void compute(const cv::Mat1b& image, Workers& workers);
  const cv::Mat1b& channel(std::size_t index) const { return channels_[index]; }
  const cv::Mat1b& smooth() const { return smooth_; }  // the image smoothed by 3 x 3
  cv::Size size() const { return channels_[0].size(); }
  // Sum over the channels of the absolute differences.
  int costAt(cv::Point here, const GradientFeatures& other, cv::Point there) const;
  // The same over the 3 x 3 px around each, which lie in the images.
  int costAround(cv::Point here, const GradientFeatures& other, cv::Point there) const;
  // costAt for all pixels of a row whose partner at +offset lies in the image; other costs stay as they are.
  void costsOfRow(int row, const GradientFeatures& other, cv::Point offset, std::uint8_t* costs) const;

 private:
  std::array<cv::Mat1b, kChannels> channels_;
  cv::Mat4b together_;  // the same channels pixel by pixel, and one row more for reading whole vectors
  cv::Mat1b smooth_;    // within padded_smooth_
  std::array<cv::Mat1b, kChannels> planes_;  // that channels_ lie in, with room for whole vectors
  cv::Mat1b padded_, padded_smooth_;
};

}  // namespace cornerstone
