// Sub-pixel disparity and its standard deviation, around whole-pixel winners.
//
// Census costs fall linearly on both sides of the truth, so two lines of opposite slope through the costs
// before, at and after the winner cross at it (equiangular fit): with s the steeper step of the two,
//   d = D + (before - after) / (2 s),   noise = CostNoise(cost) / (2 s)
// Then the fits around on the same surface (steps of at most a pixel) are averaged with weights 1 / noise^2.
// What the noise does not explain shows in the spread of the fits: of nine, half a window apart, around the
// plane through the averages. In px of the reference pair:
//   sigma^2 = spread^2 + (a noise)^2 + b^2
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/stereo/cost_sweep.h"

namespace cornerstone {

struct SubpixelInput {
  const Winners* winners = nullptr;
  const cv::Mat1b* rejection = nullptr;  // only winners with kNone count
  std::size_t cameras = 2;               // secondary ones: 1 or 2
  int window_px = 7;                     // of the sweep
  Workers* workers = nullptr;
};

struct SubpixelParams {
  int support_px = 5;  // edge of the support of the average, odd; 1: no averaging
};

class SubpixelRefiner {
 public:
  // Fills both planes, with 0 where there is no answer.
  void refine(const SubpixelInput& input, const SubpixelParams& params, cv::Mat1f& disparity_px,
              cv::Mat1f& sigma_px);

 private:
  // With a border; values far below zero and weight 0 where there is none.
  struct Planes {
    cv::Mat1f values_px, weights;
    int border_px = 0;
    void prepare(cv::Size size, int border);
    int width() const;
    const float* rowOf(const cv::Mat1f& plane, int y) const { return plane[y + border_px] + border_px; }
    float* rowOf(cv::Mat1f& plane, int y) const { return plane[y + border_px] + border_px; }
  };
  void fitEach(const SubpixelInput& input, const cv::Range& rows);
  void averageRow(int y, std::ptrdiff_t step, const Planes& from, Planes& to) const;
  void sigmaRow(int y, int reach_px);
  void writeRow(int y, const std::uint8_t* rejections, float* disparities_px, float* sigmas_px) const;

  int radius_px_ = 0;  // of the support
  Planes fits_, lines_, means_;
};

}  // namespace cornerstone
