#include "cornerstone/scan/range_scan.h"

namespace cornerstone {

RangeScan levelOf(const RangeScan& scan, std::size_t level) {
  RangeScan one = scan;
  one.further_levels.clear();
  if (level == 0) return one;
  one.beams = level <= scan.further_levels.size() ? scan.further_levels[level - 1] : std::vector<Beam>{};
  return one;
}

}  // namespace cornerstone
