// See range_bench.cpp.
#pragma once

#include "cornerstone/simulation/world.h"

namespace cornerstone::bench {

void rangePart(const World& world);

}  // namespace cornerstone::bench
