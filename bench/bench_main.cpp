// All parts, as Markdown on standard output; scripts/bench.sh makes bench/RESULTS.md of it.
#include <cstdlib>
#include <exception>
#include <opencv2/core.hpp>

#include "bench.h"

// cornerstone_bench [SEEDS of the meeting robots, 2]
int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 2;
  cv::setNumThreads(1);
  try {
    cornerstone::bench::stereoPart();
    cornerstone::bench::mappingPart();
    cornerstone::bench::registrationPart();
    cornerstone::bench::registrationLimitsPart();
    cornerstone::bench::registrationCostPart();
    cornerstone::bench::registrationMeetingPart(seeds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
