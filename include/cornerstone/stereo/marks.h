// Rows of marks: bytes that are not 0.
#pragma once

#include <cstdint>
#include <cstring>

namespace cornerstone {

// Calls action(x) for each marked pixel of a row. Most are not: they are passed eight at a time.
template <typename Action>
void forEachMarked(const std::uint8_t* marks, int count, const Action& action) {
  constexpr int kTogether = 8;
  int x = 0;
  for (; x + kTogether <= count; x += kTogether) {
    std::uint64_t together = 0;
    std::memcpy(&together, marks + x, kTogether);
    if (together == 0) continue;
    for (int i = x; i < x + kTogether; ++i)
      if (marks[i] != 0) action(i);
  }
  for (; x < count; ++x)
    if (marks[x] != 0) action(x);
}

}  // namespace cornerstone
