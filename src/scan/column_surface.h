// The nearest surface that enough pixels of one image column agree on.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/scan/column_scan.h"

namespace cornerstone {

struct ColumnPixel {
  double q = 0;               // inverse planar range, 1/m
  double sigma_q = 0;         // 1/m
  Eigen::Vector2d direction;  // |r_xy| and its heading in the base frame
};

struct ColumnSurface {
  double q = 0;
  double sigma_q = 0;
  double caution_q = 0;  // >= q: nearest that fewer pixels agree on
  Eigen::Vector2d direction;
};

// Reorders the pixels. common_sigma: in 1/m along the optical axis.
std::optional<ColumnSurface> nearestSurface(std::vector<ColumnPixel>& pixels, double common_sigma,
                                            const ScanParams& params);

}  // namespace cornerstone
