// Part of the stereo tables: see range_bench.cpp.
#pragma once

namespace cornerstone::bench {

void rangePart();

}  // namespace cornerstone::bench
