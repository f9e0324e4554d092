// The least of any stretch of a table in two look-ups: minima of all stretches of 1, 2, 4, ... entries are
// kept.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace cornerstone {

class RangeMinimum {
 public:
  RangeMinimum() = default;
  explicit RangeMinimum(std::vector<float> values) {
    levels_.push_back(std::move(values));
    for (std::size_t half = 1; 2 * half <= levels_.front().size(); half *= 2) {
      const std::vector<float>& below = levels_.back();
      std::vector<float> level(below.size() - half);
      for (std::size_t i = 0; i < level.size(); ++i) level[i] = std::min(below[i], below[i + half]);
      levels_.push_back(std::move(level));
    }
  }
  // 0 <= first <= last < size of the table.
  float of(int first, int last) const {
    const int count = last - first + 1;
    const int level = 31 - __builtin_clz(static_cast<unsigned>(count));  // the longest stretch that fits in
    const std::vector<float>& values = levels_[static_cast<std::size_t>(level)];
    return std::min(values[static_cast<std::size_t>(first)],
                    values[static_cast<std::size_t>(last + 1 - (1 << level))]);
  }

 private:
  std::vector<std::vector<float>> levels_;
};

}  // namespace cornerstone
