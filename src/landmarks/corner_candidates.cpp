#include "cornerstone/landmarks/corner_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bit_grid.h"

namespace cornerstone {
namespace {

constexpr int kDirections = 16;  // 22.5 degrees: at most 11 off, inside the dilation
constexpr int kRightAngle = kDirections / 4;
constexpr double kMinApart_rad = 0.6;  // nearer than 1.5 directions: the same corner
constexpr std::uint64_t kEveryOtherCell =
    0x5555555555555555;  // of a word: finer than the dilation needs no look

struct Candidate {
  int distance = 0;  // of both arms' cells to the edges, summed, in units of the field
  Cell cell;
  int direction = 0;
};

// The steps of a line of the arm's length in each direction, two cells apart.
using Line = std::vector<Cell>;
std::array<Line, kDirections> linesOf(double arm_cells) {
  std::array<Line, kDirections> lines;
  for (int d = 0; d < kDirections; ++d)
    for (double s = std::min(2.0, arm_cells); s <= arm_cells + 1e-9; s += 2)
      lines[static_cast<std::size_t>(d)].push_back(
          {static_cast<int>(std::lround(s * std::cos(2 * M_PI * d / kDirections))),
           static_cast<int>(std::lround(s * std::sin(2 * M_PI * d / kDirections)))});
  return lines;
}

// Walks the map band by band, each as high as a square, and keeps the best candidate of each square and
// direction.
class Searcher {
 public:
  Searcher(const cv::Mat1b& distances, const LandmarkParams& params, double resolution_m)
      : distances_(distances),
        dilated_(distances, static_cast<int>(params.dilation_m / resolution_m * kDistanceUnits),
                 static_cast<int>(params.arm_length_m / resolution_m) + 1),
        lines_(linesOf(params.arm_length_m / resolution_m)),
        square_cells_(std::max(static_cast<int>(std::lround(params.candidate_spacing_m / resolution_m)), 1)),
        best_of_band_(static_cast<std::size_t>((distances.cols / square_cells_ + 1) * kDirections)) {}

  std::vector<Candidate> search() {
    for (int row = 0; row < distances_.rows; row += 2) {
      if (row == 0 || row / square_cells_ != (row - 2) / square_cells_)
        std::fill(best_of_band_.begin(), best_of_band_.end(), kNone);
      for (int word = 0; word < dilated_.wordsPerRow(); ++word) searchWord(row, word);
    }
    return std::move(candidates_);
  }

 private:
  static constexpr int kNone = -1;

  // 64 cells of a row at once. Bit i of fits[d]: a line can run its length from cell i in direction d inside
  // the dilated edges.
  void searchWord(int row, int word) {
    const std::uint64_t here = dilated_.word(row, 64 * word) & kEveryOtherCell;
    if (here == 0) return;
    std::array<std::uint64_t, kDirections> fits;
    for (std::size_t d = 0; d < kDirections; ++d) {
      fits[d] = here;
      for (const Cell step : lines_[d]) fits[d] &= dilated_.word(row + step.row, 64 * word + step.col);
    }
    for (int d = 0; d < kDirections; ++d) {
      std::uint64_t corners =
          fits[static_cast<std::size_t>(d)] & fits[static_cast<std::size_t>((d + kRightAngle) % kDirections)];
      for (; corners != 0; corners &= corners - 1) keepBest(row, 64 * word + __builtin_ctzll(corners), d);
    }
  }

  void keepBest(int row, int col, int direction) {
    const Candidate candidate{distanceOf(row, col, direction), {col, row}, direction};
    int& best = best_of_band_[static_cast<std::size_t>(col / square_cells_ * kDirections + direction)];
    if (best == kNone) {
      best = static_cast<int>(candidates_.size());
      candidates_.push_back(candidate);
    } else if (candidate.distance < candidates_[static_cast<std::size_t>(best)].distance) {
      candidates_[static_cast<std::size_t>(best)] = candidate;
    }
  }

  int distanceOf(int row, int col, int direction) const {
    int sum = distances_(row, col);
    for (const int d : {direction, (direction + kRightAngle) % kDirections})
      for (const Cell step : lines_[static_cast<std::size_t>(d)])
        sum += distances_(row + step.row, col + step.col);
    return sum;
  }

  const cv::Mat1b& distances_;
  BitGrid dilated_;
  std::array<Line, kDirections> lines_;
  int square_cells_;
  std::vector<int> best_of_band_;  // by square and direction, index of the candidate
  std::vector<Candidate> candidates_;
};

// Kept candidates by place: squares as wide as candidates must be apart.
class KeptCandidates {
 public:
  KeptCandidates(const cv::Size& cells, double apart_cells)
      : apart_cells_(apart_cells),
        cols_(static_cast<int>(cells.width / apart_cells) + 1),
        rows_(static_cast<int>(cells.height / apart_cells) + 1),
        squares_(static_cast<std::size_t>(cols_ * rows_)) {}

  // Keeps a candidate unless a kept one of nearly its direction is near.
  bool keep(const Candidate& candidate) {
    const int col = static_cast<int>(candidate.cell.col / apart_cells_);
    const int row = static_cast<int>(candidate.cell.row / apart_cells_);
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r)
      for (int c = std::max(col - 1, 0); c <= std::min(col + 1, cols_ - 1); ++c)
        for (const Candidate& better : squares_[static_cast<std::size_t>(r * cols_ + c)])
          if (isDouble(candidate, better)) return false;
    squares_[static_cast<std::size_t>(row * cols_ + col)].push_back(candidate);
    return true;
  }

 private:
  bool isDouble(const Candidate& a, const Candidate& b) const {
    constexpr int kNear = static_cast<int>(kMinApart_rad / (2 * M_PI) * kDirections);
    const int x = a.cell.col - b.cell.col, y = a.cell.row - b.cell.row;
    const int turn = std::abs(a.direction - b.direction);
    return x * x + y * y < apart_cells_ * apart_cells_ && std::min(turn, kDirections - turn) <= kNear;
  }

  double apart_cells_;
  int cols_;
  int rows_;
  std::vector<std::vector<Candidate>> squares_;
};

}  // namespace

std::vector<Pose2> findCornerCandidates(const DistanceField& field, const GridGeometry& geometry,
                                        const LandmarkParams& params) {
  std::vector<Candidate> candidates = Searcher(field.cells(), params, geometry.resolution_m).search();
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  KeptCandidates kept(field.cells().size(),
                      std::max(1.5 * params.candidate_spacing_m / geometry.resolution_m, 1.0));
  std::vector<Pose2> poses;
  for (const Candidate& candidate : candidates) {
    if (!kept.keep(candidate)) continue;
    const Eigen::Vector2d at = geometry.centreOf(candidate.cell);
    poses.push_back({at.x(), at.y(), wrapAngle(2 * M_PI * candidate.direction / kDirections)});
  }
  return poses;
}

}  // namespace cornerstone
