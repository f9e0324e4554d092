#include "columns.h"

#include <algorithm>
#include <cmath>

namespace cornerstone::bench {
namespace {

constexpr double kShare = 0.2, kLeast_m = 0.2;
constexpr int kWidthShare = 80;  // of the image's width: about a degree
constexpr double kNothing_m = 100;

double tolerance(double at_m) { return std::max(kLeast_m, kShare * at_m); }

}  // namespace

std::vector<TrueColumn> trueColumns(const std::vector<double>& ranges_m) {
  const int count = static_cast<int>(ranges_m.size()), reach = count / kWidthShare;
  std::vector<TrueColumn> truth;
  for (int c = 0; c < count; ++c) {
    TrueColumn here{ranges_m[static_cast<std::size_t>(c)], kNothing_m, 0};
    for (int i = std::max(c - reach, 0); i <= std::min(c + reach, count - 1); ++i) {
      const double range_m = ranges_m[static_cast<std::size_t>(i)];
      here.nearest_m = std::min(here.nearest_m, range_m > 0 ? range_m : kNothing_m);
      here.farthest_m = std::max(here.farthest_m, range_m > 0 ? range_m : kNothing_m);
    }
    truth.push_back(here);
  }
  return truth;
}

ColumnFault faultOf(double range_m, const TrueColumn& truth) {
  const bool answered = range_m > 0;
  if (answered && range_m < kEnds_m.back() && range_m < truth.nearest_m - tolerance(truth.nearest_m))
    return ColumnFault::kPhantom;
  if (truth.range_m == 0 || truth.range_m >= kMissedWithin_m) return ColumnFault::kNone;
  if (!answered) return ColumnFault::kSilent;
  return range_m > truth.farthest_m + tolerance(truth.farthest_m) ? ColumnFault::kMissed : ColumnFault::kNone;
}

void ColumnCounts::add(double range_m, const TrueColumn& truth) {
  ++all;
  near += truth.range_m > 0 && truth.range_m < kMissedWithin_m;
  const ColumnFault fault = faultOf(range_m, truth);
  phantom += fault == ColumnFault::kPhantom;
  missed += fault == ColumnFault::kMissed;
  silent += fault == ColumnFault::kSilent;
  if (!(range_m > 0 && truth.range_m > 0)) return;
  for (std::size_t i = 0; i < kEnds_m.size(); ++i)
    if (truth.range_m < kEnds_m[i]) {
      errors_m[i].push_back(std::abs(range_m - truth.range_m));
      break;
    }
}

}  // namespace cornerstone::bench
