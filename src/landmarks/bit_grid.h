// Cells of a grid as bits, 64 neighbours of a row in a word, so that a question asked of every cell is asked
// of 64 at once. Cells outside the grid are unset.
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace cornerstone {

class BitGrid {
 public:
  // Sets the cells whose value is at most `limit`. Words are asked for up to reach_cells beyond the grid.
  BitGrid(const cv::Mat1b& values, int limit, int reach_cells)
      : rows_(values.rows),
        words_((values.cols + 63) / 64),
        margin_(reach_cells / 64 + 2),
        bits_(static_cast<std::size_t>(rows_ * pitch())) {
    for (int row = 0; row < rows_; ++row)
      for (int word = 0; word < words_; ++word)
        bits_[static_cast<std::size_t>(row * pitch() + margin_ + word)] =
            bitsOf(values[row] + 64 * word, std::min(64, values.cols - 64 * word), limit);
  }

  int wordsPerRow() const { return words_; }

  // Cells col to col + 63 of a row, the first as the lowest bit.
  std::uint64_t word(int row, int col) const {
    if (row < 0 || row >= rows_) return 0;
    const int shifted = col + 64 * margin_, bit = shifted % 64;
    const std::uint64_t* at = &bits_[static_cast<std::size_t>(row * pitch() + shifted / 64)];
    return bit == 0 ? at[0] : at[0] >> bit | at[1] << (64 - bit);
  }

 private:
  static std::uint64_t bitsOf(const unsigned char* cells, int count, int limit) {
    unsigned char lowest = 255;
    for (int i = 0; i < count; ++i) lowest = std::min(lowest, cells[i]);
    if (lowest > limit) return 0;  // most of a map
    std::uint64_t bits = 0;
    for (int i = 0; i < count; ++i) bits |= static_cast<std::uint64_t>(cells[i] <= limit) << i;
    return bits;
  }
  int pitch() const { return words_ + 2 * margin_; }

  int rows_;
  int words_;
  int margin_;  // unset words on either side
  std::vector<std::uint64_t> bits_;
};

}  // namespace cornerstone
