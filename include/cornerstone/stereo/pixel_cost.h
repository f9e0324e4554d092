// What a pixel alone says of a disparity, as opposed to the windows of the search.
#pragma once

#include <opencv2/core.hpp>

#include "cornerstone/stereo/cost_sweep.h"

namespace cornerstone {

// Cost of the 3 x 3 px around a pixel: mean over the cameras that see all of them; that of unrelated pixels
// if none does.
double costAround(const SweepInput& input, cv::Point at, int disparity_px);

// Whether disparities a little off cost at least so much: the pixel itself shows something, and is no bare
// wall beside a textured thing.
bool costsMoreAside(const SweepInput& input, cv::Point at, int own_px, double smallest_cost);

constexpr double kUnrelatedCostAround = 9 * kChanceCost / 2.0;
// What noise makes of it. Half or double in GapFill: two thousandths fewer or more answers on photographs.
constexpr double kNoiseCostAround = 40;

}  // namespace cornerstone
