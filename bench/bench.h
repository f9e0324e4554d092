// What the parts of the benchmark share: medians of interleaved repeats, tables in Markdown.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace cornerstone::bench {

void stereoPart();
void mappingPart();
void mappingSizePart();
void toursPart(int seeds);
void scanFitPart();
void registrationPart();
void registrationLimitsPart();
void registrationSelfSimilarPart();
void registrationCostPart();
void registrationMeetingPart(int seeds);

inline double elapsed_ms(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A number as text with so many digits behind the point.
inline std::string text(double value, int digits = 2) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  return buffer;
}
inline std::string percent(double share, int digits = 1) { return text(100 * share, digits) + "%"; }

inline void printRow(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  std::puts(line.c_str());
  std::fflush(stdout);
}
inline void printHead(const std::vector<std::string>& cells) {
  std::puts("");
  printRow(cells);
  printRow(std::vector<std::string>(cells.size(), "---"));
}

}  // namespace cornerstone::bench
