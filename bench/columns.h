// What a robot drives by: the range of the nearest obstacle in every image column, judged by the renderer's
// depth.
#pragma once

#include <array>
#include <vector>

namespace cornerstone::bench {

constexpr std::array<double, 4> kEnds_m{1, 2, 4, 8};  // of the bands of true range
constexpr double kMissedWithin_m = 4;                 // obstacles that matter

struct TrueColumn {
  double range_m = 0;                    // 0: nothing there
  double nearest_m = 0, farthest_m = 0;  // in the columns around: edges are where they are to a degree
};
std::vector<TrueColumn> trueColumns(const std::vector<double>& ranges_m);

enum class ColumnFault { kNone, kPhantom, kMissed, kSilent };
// An answer that is nearer than all that is true around by more than 20% and 0.2 m is a phantom, one that is
// farther by as much misses the obstacle. 0: no answer.
ColumnFault faultOf(double range_m, const TrueColumn& truth);

struct ColumnCounts {
  std::size_t all = 0, near = 0;  // near: with an obstacle that matters
  std::size_t phantom = 0, missed = 0, silent = 0;
  std::array<std::vector<double>, kEnds_m.size()> errors_m;

  void add(double range_m, const TrueColumn& truth);
};

}  // namespace cornerstone::bench
