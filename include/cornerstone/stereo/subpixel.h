// Sub-pixel disparity by least squares, with its standard deviation, around whole-pixel winners (Lucas and
// Kanade, 1981).
//
// At a reference pixel with winner D, each camera that sees it at s = x + D * shift gives one equation p d =
// q,
//   p = shift * (I_ref' + I_sec') / 2,   q = p D + I_ref(x) - I_sec(s)
// and the pixels around on the same surface (winners differ by at most a pixel from step to step) are added
// up:
//   d = sum(p q) / sum(p p),   sigma^2 = noise^2 / sum(p p)
// sum(p p) is formed as the product of the two cameras' own gradients: their noise is independent, so it does
// not pull d towards whole pixels. `noise` comes from what the equations leave. In px of the reference pair.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace cornerstone {

struct SubpixelView {
  const cv::Mat1b* image = nullptr;
  cv::Point2d shift;  // as in TrinocularRig
};

struct SubpixelInput {
  const cv::Mat1b* reference = nullptr;
  std::vector<SubpixelView> views;
  const cv::Mat1s* winners_px =
      nullptr;  // whole disparities, 0 where there is none; may be wider than the image
};

struct SubpixelParams {
  int support_px = 9;  // edge of the support at most: odd
};

class SubpixelRefiner {
 public:
  // Fills both planes, with 0 where there is no answer.
  void refine(const SubpixelInput& input, const SubpixelParams& params, cv::Mat1f& disparity_px,
              cv::Mat1f& sigma_px);

 private:
  struct Plane {  // an image without its offset and its finest noise
    cv::Mat1f level;
    cv::Mat1f gradient_x, gradient_y;
  };
  struct Sums {  // of the equations p (d - winner) = e, per pixel or over a support; with a border of zeros
    cv::Mat1f pp, pe, ee, count;
    void clear(cv::Size size);
  };
  void prepare(const cv::Mat1b& image, Plane& plane);
  void addEquations(const SubpixelView& view, const cv::Mat1s& winners_px);
  void sumOverSupport(const Sums& in, cv::Point step, Sums& out) const;
  void solve(cv::Mat1f& disparity_px, cv::Mat1f& sigma_px) const;

  cv::Mat1f smooth_, mean_;
  Plane reference_, secondary_;
  int radius_px_ = 0;     // of the support, and the width of the planes' borders
  cv::Mat1f winners_px_;  // with a border; far below zero where there is none
  Sums pixel_, row_, support_;
};

}  // namespace cornerstone
