// Foreground fattening: a window half over a depth edge matches whichever side has more texture, so surfaces
// with texture grow over their surroundings. Beside a step of the winners a pixel therefore has to show that
// it belongs to its own side. In the 3 x 3 px around it
// - the disparity of the other side must cost clearly more than its own, where that side has an answer;
// - disparities a little off must cost clearly more than its own, where it has none: the pixel itself then
//   shows something, and is no bare wall beside a textured thing.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/winner_steps.h"

namespace cornerstone {

class EdgeCheck {
 public:
  struct How {
    double smallest_cost_ratio;  // what is less is not "clearly more"; pixels beyond doubt need less
    const cv::Mat1b& evidence;   // Evidence
    Workers& workers;
  };
  // Turns kNone into kUniqueness in `rejection`.
  void check(const Winners& winners, const SweepInput& input, const How& how, cv::Mat1b& rejection);

 private:
  bool standsOut(const Winners& winners, const SweepInput& input, cv::Point at,
                 double smallest_cost_ratio) const;

  std::vector<WinnerSteps> steps_;  // by worker
  cv::Mat1b before_;                // rejections as they came in
};

}  // namespace cornerstone
