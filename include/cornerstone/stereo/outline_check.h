// Where a surface ends. Windows and gradients reach some pixels over the outline of a thing, and where there
// is nothing else to match (a bare wall behind it, or what a second camera does not see) the thing grows by
// all of that reach. The brightness tells: a pixel beside a depth step from which the image stays even until
// a brightness edge on its own, nearer side is no part of that side.
//
//   disparity    12 12 12 12 12 12 |  4  4  4
//   brightness   80 80 90 30 30 30 | 30 30 30      the three pixels left of the step are dropped
//
// The farther side is left alone: beside a step it is right in nine of ten pixels.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/winner_steps.h"

namespace cornerstone {

class OutlineCheck {
 public:
  // Turns answers into kUniqueness.
  void check(const Winners& winners, const SweepInput& input, Workers& workers, Disparity& disparity);

 private:
  struct Found {  // by one worker
    WinnerSteps steps;
    std::vector<std::uint8_t> ends;
    std::vector<cv::Point> outlying;  // to be dropped
  };
  struct Ends {  // what is looked at
    const Winners& winners;
    const cv::Mat1b& grey;
    Found& found;
  };
  void checkRow(const Ends& in, int y) const;
  void checkSide(const Ends& in, cv::Point at, cv::Point outward) const;
  const std::uint8_t* endsOf(const Ends& in, int y) const;

  int window_radius_px_ = 0;
  cv::Mat1b before_;  // rejections as they came in
  std::vector<Found> found_;
};

}  // namespace cornerstone
