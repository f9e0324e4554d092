// Gaps in a surface. Every check also rejects right answers: single pixels, seams along weak texture, the rim
// of a hole. A pixel without an answer between two answers of one surface, in its row or its column, is given
// what lies between them unless its own images fit clearly worse there than where they fit best. On
// photographs six of seven such answers are right.
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/stereo/cost_sweep.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

struct GapParams {
  int largest_px = 10;        // pixels without an answer between the two; below 256
  float largest_step_px = 1;  // between the two answers
};

struct GapInput {
  const Winners& winners;
  const SweepInput& sweep;
  Workers& workers;
};

class GapFill {
 public:
  // Turns rejections into answers. Those that no camera sees or that fit best at the end of the search, where
  // something nearer may stand, stay.
  void fill(const GapInput& input, const GapParams& params, Disparity& disparity);

 private:
  struct Gap {
    cv::Point before, step;  // the answer before it, and from one of its pixels to the next
    int length_px = 0;
    cv::Point after() const { return before + (length_px + 1) * step; }
  };
  struct Images {
    const GapInput& input;
    const Disparity& disparity;
  };
  void look(const Images& images, cv::Point after, cv::Point step);
  static bool fits(const Images& images, cv::Point at, int disparity_px);
  void propose(const Images& images, const Gap& gap);
  void lookAlong(const Images& images, int y);
  void lookDown(const Images& images, const cv::Range& columns);
  void accept(int y, Disparity& disparity) const;

  GapParams params_;
  cv::Mat1f disparity_px_, sigma_px_;  // proposed
  cv::Mat1b gap_px_;                   // length of the gap that it was proposed for; 0: nothing is proposed
};

}  // namespace cornerstone
