// The nearest surface that enough pixels of one image column agree on.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/scan/column_scan.h"

namespace cornerstone {

// Where the pixels of an image column look, in the plane of the base frame: evenly down the column. A ray's
// length is |r_xy|.
struct ColumnRays {
  Eigen::Vector2d first, step;
  Eigen::Vector2d of(double row) const { return first + row * step; }
};

struct ColumnPixel {
  double q = 0;        // inverse planar range, 1/m
  double sigma_q = 0;  // 1/m
  double weight = 0;   // 1 / sigma_q^2
  double row = 0;
};

struct ColumnSurface {
  double q = 0;
  double sigma_q = 0;
  double caution_q = 0;  // >= q: nearest that fewer pixels agree on
  Eigen::Vector2d direction;
};

// Reorders the pixels. common_sigma: in 1/m along the optical axis.
std::optional<ColumnSurface> nearestSurface(std::vector<ColumnPixel>& pixels, const ColumnRays& rays,
                                            double common_sigma, const ScanParams& params);

}  // namespace cornerstone
