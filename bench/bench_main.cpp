// All parts, as Markdown on standard output; scripts/bench.sh makes bench/RESULTS.md of it.
// usage: cornerstone_bench [--seeds N] [--stereo-only] [--stereo-sets FOLDER...]
//        cornerstone_bench --tours N       the long tours alone, N seeds a world
//        cornerstone_bench --meetings N    the robots that meet alone, N seeds a world
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "bench.h"
#include "stereo_sets.h"

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  std::vector<std::string> words(argv + 1, argv + argc), folders;
  int seeds = 1;  // runs a world of the robots that meet
  if (words.size() > 1 && words[0] == "--seeds") {
    seeds = std::atoi(words[1].c_str());
    words.erase(words.begin(), words.begin() + 2);
  }
  // The seeds of a part that was asked for alone; 0: it was not.
  const auto aloneSeeds = [&](const std::string& part) {
    if (words.size() != 2 || words[0] != part) return 0;
    const int wanted = std::atoi(words[1].c_str());
    if (wanted > 0) words.clear();
    return wanted;
  };
  const int tours = aloneSeeds("--tours"), meetings = aloneSeeds("--meetings");
  const auto is_sets = std::find(words.begin(), words.end(), "--stereo-sets");
  if (is_sets != words.end()) folders.assign(is_sets + 1, words.end());
  words.erase(is_sets, words.end());
  const bool stereo_only = words == std::vector<std::string>{"--stereo-only"};
  if (!words.empty() && !stereo_only) {
    std::fputs(
        "usage: cornerstone_bench [--seeds N] [--stereo-only] [--stereo-sets FOLDER...]\n"
        "       cornerstone_bench --tours N\n"
        "       cornerstone_bench --meetings N\n",
        stderr);
    return 2;
  }
  try {
    if (tours > 0) {
      cornerstone::bench::toursPart(tours);
      cornerstone::bench::scanFitPart();
      return 0;
    }
    if (meetings > 0) {
      cornerstone::bench::registrationMeetingPart(meetings);
      return 0;
    }
    cornerstone::bench::stereoPart();
    if (!folders.empty()) cornerstone::bench::stereoSetsPart(folders);
    if (stereo_only) return 0;
    cornerstone::bench::mappingPart();
    cornerstone::bench::mappingSizePart();
    cornerstone::bench::registrationPart();
    cornerstone::bench::registrationLimitsPart();
    cornerstone::bench::registrationSelfSimilarPart();
    cornerstone::bench::registrationCostPart();
    cornerstone::bench::registrationMeetingPart(seeds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
