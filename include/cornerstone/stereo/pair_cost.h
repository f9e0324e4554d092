// The matching cost of one image row at one disparity, summed over the camera pairs that see each pixel.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "cornerstone/stereo/cost_sweep.h"

namespace cornerstone {

// Part of a row that a secondary camera sees at one disparity, and where.
struct SeenRow {
  int begin = 0, end = 0;                // reference columns; empty: begin == end
  const std::uint8_t* census = nullptr;  // of the secondary pixel seen at reference column 0
};
SeenRow seenRow(const SecondaryView& view, int row, int disparity_px);

// costs[x] = 0 .. 2 * kCensusBits; one camera counts double; none: kCensusBits, the cost of chance.
void pairCostRow(const std::uint8_t* reference, const SeenRow& first, const SeenRow& second,
                 cv::Range columns, std::uint8_t* costs);

}  // namespace cornerstone
