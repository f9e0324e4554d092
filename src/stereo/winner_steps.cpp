#include "cornerstone/stereo/winner_steps.h"

#include <algorithm>

namespace cornerstone {
namespace {

constexpr int kStep_px = 1;  // neighbours on one surface differ by no more

// Beyond -kStep .. kStep, as one comparison.
inline bool steps(short one, short other) {
  return static_cast<unsigned short>(one - other + kStep_px) > 2 * kStep_px;
}

void markSteps(const short* here, const short* there, int count, std::uint8_t* marks) {
  for (int x = 0; x < count; ++x)
    marks[x] = static_cast<std::uint8_t>(marks[x] | static_cast<std::uint8_t>(steps(here[x], there[x])));
}

}  // namespace

const std::uint8_t* WinnerSteps::of(const cv::Mat1s& disparity_px, int y, int apart_px) {
  const int width = disparity_px.cols, beside = std::max(width - apart_px, 0);
  marks_.assign(static_cast<std::size_t>(width), 0);
  const short* here = disparity_px[y];
  markSteps(here, disparity_px[std::max(y - apart_px, 0)], width, marks_.data());
  markSteps(here, disparity_px[std::min(y + apart_px, disparity_px.rows - 1)], width, marks_.data());
  markSteps(here, here + apart_px, beside, marks_.data());
  markSteps(here + width - beside, here, beside, marks_.data() + (width - beside));
  return marks_.data();
}

}  // namespace cornerstone
