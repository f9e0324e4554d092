// Near surfaces that the windows of large images cannot see: what is so near that its texture is blurred over
// more pixels than a window has shows little or nothing in one, but enough in images shrunk to a quarter.
// Left silent, what is seen past it would be taken for the nearest obstacle.
//
// Areas where the fine level is silent take the answers of the shrunk images, where
// - most of the coarse pixels around show something themselves: a window that reaches over the outline of a
//   thing answers before a bare wall, too, four times as far as in the large images;
// - the four coarse answers around a pixel are of one surface.
// Sigma is that of the least certain of the four, in fine pixels.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/base/workers.h"
#include "cornerstone/stereo/box_sums.h"
#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

class CoarseFill {
 public:
  static constexpr int kFactor = 4;  // a 64th of the cost; half would cost an eighth
  // Shrunk images have at least this width: as small as images for stereo are. Smaller large ones have no
  // need of a coarse level: at 320x240 no near wall is missed.
  static constexpr int kLeastWidth_px = 160;

  static bool suits(cv::Size size) { return size.width / kFactor >= kLeastWidth_px; }
  // Means over squares of kFactor; pixels left over at the right and below are left out.
  static void shrink(const cv::Mat1b& image, cv::Mat1b& shrunk);

  // Whether the fine level is silent over an area that a coarse window may answer. `coarse_window_px`: edge.
  bool findSilent(const cv::Mat1b& rejection, int coarse_window_px, Workers& workers);

  struct Coarse {
    const Disparity& disparity;
    const SweepInput& sweep;
    double smallest_cost_ratio;  // as EdgeCheck
    float largest_step_px;       // between neighbours on one surface
  };
  // In the areas that the last findSilent() found.
  void fill(const Coarse& coarse, Workers& workers, Disparity& disparity);

 private:
  void findShown(const Coarse& coarse, Workers& workers);
  void findUsed(Workers& workers);
  void fillBetween(const Coarse& coarse, cv::Point cell, Disparity& disparity) const;

  int area_px_ = 0;                  // edge of what is looked at around a coarse pixel
  cv::Mat1b silent_, shown_, used_;  // coarse; silent_: how many fine pixels, others: 1 or 0
  cv::Mat1b wanted_;                 // coarse: in a silent area
  cv::Mat1s silent_sums_, wanted_sums_, shown_sums_;
  BoxSums box_sums_;
};

}  // namespace cornerstone
