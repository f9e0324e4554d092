// What stereo knows of one view: a disparity for each reference pixel it is sure of, and why not for the
// others.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "cornerstone/stereo/trinocular_rig.h"

namespace cornerstone {

// Why a pixel has no answer; the values are those of the `rejections` image.
enum class Rejection : std::uint8_t {
  kNone = 0,        // the pixel has an answer
  kOutside = 1,     // no secondary camera sees it at any disparity searched
  kTexture = 2,     // nothing to correlate
  kUniqueness = 3,  // another disparity matches nearly as well
  kLeftRight = 4,   // every secondary view that sees the pixel has a better one for the same place
  kSurface = 5,     // part of a surface too small to be real (spikes: paper, section 2.1)
  kRange = 6,       // best at the end of the searched range
  kPairs = 7,       // the two pairs disagree: one secondary view has a better one, the other has not
};

struct Disparity {
  cv::Mat1f disparity_px;  // > 0; 0: no answer
  cv::Mat1f sigma_px;      // standard deviation of the answer; 0 where there is none
  cv::Mat1b rejection;     // Rejection
  TrinocularRig rig;
};

// Takes a pixel's answer away.
void reject(Disparity& disparity, cv::Point at, Rejection why);

// Share of the pixels with texture that have an answer; empty: hardly any has texture. Near 1 as a rule. When
// the images do not fit the rig (cameras swapped, another rig's calibration, images of different instants),
// pixels with texture match nowhere.
std::optional<double> matchedShare(const Disparity& disparity);

}  // namespace cornerstone
