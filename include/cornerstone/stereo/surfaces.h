// Continuous surfaces of a disparity image: neighbours whose disparities differ by no more than a step belong
// to one. A mismatch makes a surface of its own, small or without a single pixel that is beyond doubt (the
// paper's cure for spikes, section 2.1, and Canny's for weak edges: what hangs together with the strong may
// be weak).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/stereo/validation.h"

namespace cornerstone {

struct SurfaceParams {
  int smallest_px = 20;         // pixels of a surface
  int smallest_strong_px = 10;  // strong pixels of a surface
  float step_px = 1;            // of disparity between neighbours
};

class SurfaceFilter {
 public:
  enum Verdict : std::uint8_t { kGood = 0, kSmall = 1, kWeak = 2 };  // of a pixel's surface
  // Disparity 0: no answer, no surface, kGood. Pixels are strong where `evidence` is Evidence::kStrong.
  void judge(const cv::Mat1f& disparity_px, const cv::Mat1b& evidence, const SurfaceParams& params,
             cv::Mat1b& verdicts);

 private:
  struct Surface {
    int parent = 0;  // another surface that this one is part of, or itself
    int pixels = 0, strong = 0;
  };
  struct Run {  // neighbours of one surface in a row, and what is above them
    const float *here, *above;
    const int* labels_above;
    int begin = 0, end = 0;
  };
  int rootOf(int surface);
  int join(int one, int other);  // root of both
  int surfaceOf(const Run& run, float step_px);
  void label(const cv::Mat1f& disparity_px, const cv::Mat1b& evidence, float step_px);
  static Verdict verdictOn(const Surface& surface, const SurfaceParams& params);

  cv::Mat1i labels_;
  std::vector<int> nothing_above_;  // labels before the first row
  std::vector<Surface> surfaces_;
  std::vector<std::uint8_t> verdict_of_;  // by label + 1
};

}  // namespace cornerstone
