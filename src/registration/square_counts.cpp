#include "cornerstone/registration/square_counts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cornerstone/landmarks/edges.h"

namespace cornerstone {
namespace {

SquareCounts emptyCounts(const Eigen::Vector2f& origin_m, const Eigen::Vector2d& size_m, double square_m) {
  SquareCounts counts;
  counts.origin_m = origin_m;
  counts.square_m = square_m;
  counts.cols = std::max(static_cast<int>(std::ceil(size_m.x() / square_m - 1e-6)), 1);
  counts.rows = std::max(static_cast<int>(std::ceil(size_m.y() / square_m - 1e-6)), 1);
  const auto squares = static_cast<std::size_t>(counts.cols) * static_cast<std::size_t>(counts.rows);
  counts.free.resize(squares);
  counts.occupied.resize(squares);
  return counts;
}

// For each of `count` pieces in a row, the square that holds its middle.
std::vector<int> squaresOf(int count, double squares_per_piece, int squares) {
  std::vector<int> of(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    of[static_cast<std::size_t>(i)] = std::min(static_cast<int>((i + 0.5) * squares_per_piece), squares - 1);
  return of;
}

}  // namespace

bool SquareCounts::known(const Eigen::Vector2f& point_m) const {
  const Eigen::Vector2f at = (point_m - origin_m) / static_cast<float>(square_m);
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < static_cast<float>(cols) && at.y() < static_cast<float>(rows)))
    return false;
  const auto square = static_cast<std::size_t>(static_cast<int>(at.y()) * cols + static_cast<int>(at.x()));
  return free[square] + occupied[square] > 0;
}

std::vector<Eigen::Vector2f> SquareCounts::knownSquares() const {
  std::vector<Eigen::Vector2f> squares;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < cols; ++c) {
      const auto square = static_cast<std::size_t>(r * cols + c);
      if (free[square] + occupied[square] == 0) continue;
      squares.push_back(origin_m +
                        static_cast<float>(square_m) *
                            Eigen::Vector2f(static_cast<float>(c) + 0.5f, static_cast<float>(r) + 0.5f));
    }
  return squares;
}

SquareCounts countSquares(const GridGeometry& geometry, const cv::Mat1b& states, double square_m) {
  SquareCounts counts =
      emptyCounts({static_cast<float>(geometry.origin_x_m), static_cast<float>(geometry.origin_y_m)},
                  {geometry.cols * geometry.resolution_m, geometry.rows * geometry.resolution_m}, square_m);
  const double ratio = geometry.resolution_m / square_m;
  counts.cells_per_square = 1 / (ratio * ratio);
  const std::vector<int> col_of = squaresOf(geometry.cols, ratio, counts.cols);
  const std::vector<int> row_of = squaresOf(geometry.rows, ratio, counts.rows);
  // Both counts of a square in one number: occupied cells above, free ones below.
  static constexpr std::array<std::uint32_t, 3> kCount{0, 1, 1u << 16};
  std::vector<std::uint32_t> both(static_cast<std::size_t>(counts.cols));
  for (int r = 0; r < geometry.rows; ++r) {
    const unsigned char* state = states[r];
    for (std::size_t c = 0; c < col_of.size(); ++c)
      both[static_cast<std::size_t>(col_of[c])] += kCount[state[c]];
    if (r + 1 < geometry.rows &&
        row_of[static_cast<std::size_t>(r + 1)] == row_of[static_cast<std::size_t>(r)])
      continue;
    const auto first = static_cast<std::size_t>(row_of[static_cast<std::size_t>(r)] * counts.cols);
    for (std::size_t s = 0; s < both.size(); ++s) {
      counts.free[first + s] = static_cast<std::uint16_t>(both[s]);
      counts.occupied[first + s] = static_cast<std::uint16_t>(both[s] >> 16);
      both[s] = 0;
    }
  }
  return counts;
}

SquareCounts inLargerSquares(const SquareCounts& counts, double square_m) {
  const double ratio = counts.square_m / square_m;
  SquareCounts larger =
      emptyCounts(counts.origin_m, {counts.cols * counts.square_m, counts.rows * counts.square_m}, square_m);
  larger.cells_per_square = counts.cells_per_square / (ratio * ratio);
  const std::vector<int> col_of = squaresOf(counts.cols, ratio, larger.cols);
  const std::vector<int> row_of = squaresOf(counts.rows, ratio, larger.rows);
  for (int r = 0; r < counts.rows; ++r)
    for (int c = 0; c < counts.cols; ++c) {
      const auto from = static_cast<std::size_t>(r * counts.cols + c);
      const auto to = static_cast<std::size_t>(row_of[static_cast<std::size_t>(r)] * larger.cols +
                                               col_of[static_cast<std::size_t>(c)]);
      larger.free[to] = static_cast<std::uint16_t>(larger.free[to] + counts.free[from]);
      larger.occupied[to] = static_cast<std::uint16_t>(larger.occupied[to] + counts.occupied[from]);
    }
  return larger;
}

}  // namespace cornerstone
