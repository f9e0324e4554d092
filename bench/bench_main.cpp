// All parts, as Markdown on standard output; scripts/bench.sh makes bench/RESULTS.md of it.
#include <exception>
#include <opencv2/core.hpp>

#include "bench.h"

int main() {
  cv::setNumThreads(1);
  try {
    cornerstone::bench::stereoPart();
    cornerstone::bench::mappingPart();
    cornerstone::bench::mappingSizePart();
    cornerstone::bench::registrationPart();
    cornerstone::bench::registrationLimitsPart();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
