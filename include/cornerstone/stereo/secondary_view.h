// A secondary camera: its features, where it sees a reference pixel, and its features in the order in which
// the disparities of a reference row ask for them.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/gradient_features.h"
#include "cornerstone/stereo/sweep_kernels.h"

namespace cornerstone {

class SecondaryView {
 public:
  // `shift` as in TrinocularRig: along one image axis. The features are held by reference.
  void prepare(const GradientFeatures& features, const cv::Point2d& shift, int disparities);
  // Of one caller of linesOf(): holds what it returns until the next call.
  using Gathered = std::array<cv::Mat1b, GradientFeatures::kChannels>;
  const GradientFeatures& features() const { return *features_; }
  int disparities() const { return disparities_; }
  bool vertical() const { return vertical_; }  // the shift is along columns
  // Seen pixel less reference pixel, rounded to whole pixels.
  cv::Point offsetAt(int disparity_px) const {
    return {(shift_fixed_.x * disparity_px + kHalf) >> kFractionBits,
            (shift_fixed_.y * disparity_px + kHalf) >> kFractionBits};
  }
  // How many of the disparities 1 .. `disparities` each pixel of a row is seen at.
  const short* seenOf(int row) const {
    return vertical_ ? seen_[static_cast<std::size_t>(row)].data() : seen_[0].data();
  }
  // Of disparities 1 .. `disparities` of a row, columns.start being column 0. May be called at the same time
  // with other `gathered`.
  SeenLines linesOf(int row, const cv::Range& columns, Gathered& gathered) const;

 private:
  static constexpr int kFractionBits = 16, kHalf = 1 << (kFractionBits - 1);
  int lineCount() const { return vertical_ ? features_->size().width : features_->size().height; }
  int lineLength() const { return vertical_ ? features_->size().height : features_->size().width; }
  void countSeen();
  void gather(int row, const cv::Range& columns, Gathered& gathered) const;

  const GradientFeatures* features_ = nullptr;
  cv::Point shift_fixed_;
  bool vertical_ = false, backwards_ = false, unit_ = true;
  int disparities_ = 0;
  std::vector<int> steps_;  // at disparity i + 1: pixels along the line
  // Lines along the shift: turned so that the disparity grows with the address, with a border at the end.
  std::array<cv::Mat1b, GradientFeatures::kChannels> lines_;
  cv::Mat1b turned_;
  std::vector<std::vector<short>> seen_;  // by row; one for all where the shift is along rows
};

}  // namespace cornerstone
