#include "cornerstone/landmarks/corner_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace cornerstone {
namespace {

constexpr int kDirections = 16;  // 22.5 degrees: at most 11 off, inside the dilation
constexpr int kRightAngle = kDirections / 4;
constexpr double kMinApart_rad = 0.6;  // candidates closer than 1.5 directions are the same corner

struct Candidate {
  double mean_distance_cells = 0;  // of both arms to the edges
  Pose2 pose;
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

class Searcher {
 public:
  Searcher(const cv::Mat1f& distances, double arm_cells, double dilation_cells)
      : distances_(distances), lines_(linesOf(arm_cells)), dilation_(static_cast<float>(dilation_cells)) {}

  bool dilated(int col, int row) const { return distances_(row, col) <= dilation_; }

  // Bit i: a line can run its length in direction i inside the dilated edges.
  unsigned orientations(int col, int row) const {
    unsigned bits = 0;
    for (unsigned d = 0; d < kDirections; ++d)
      if (lineFits(col, row, lines_[d])) bits |= 1u << d;
    return bits;
  }

  double meanDistance(int col, int row, int direction) const {
    double sum = distances_(row, col);
    const Line& one = lines_[static_cast<std::size_t>(direction)];
    const Line& other = lines_[static_cast<std::size_t>((direction + kRightAngle) % kDirections)];
    for (const Line* line : {&one, &other})
      for (const Cell step : *line) sum += distances_(row + step.row, col + step.col);
    return sum / static_cast<double>(1 + one.size() + other.size());
  }

 private:
  bool lineFits(int col, int row, const Line& line) const {
    for (const Cell step : line) {
      const int c = col + step.col, r = row + step.row;
      if (c < 0 || r < 0 || c >= distances_.cols || r >= distances_.rows || !dilated(c, r)) return false;
    }
    return true;
  }

  const cv::Mat1f& distances_;
  std::array<Line, kDirections> lines_;
  float dilation_;
};

void suppressDoubles(std::vector<Candidate>& candidates, double apart_m) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.mean_distance_cells < b.mean_distance_cells;
  });
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& better) {
      return (better.pose.translation() - candidate.pose.translation()).squaredNorm() < apart_m * apart_m &&
             std::abs(wrapAngle(better.pose.yaw_rad - candidate.pose.yaw_rad)) < kMinApart_rad;
    });
    if (!known) kept.push_back(candidate);
  }
  candidates = std::move(kept);
}

}  // namespace

std::vector<Pose2> findCornerCandidates(const DistanceField& field, const GridGeometry& geometry,
                                        const LandmarkParams& params) {
  const double resolution_m = geometry.resolution_m;
  const Searcher searcher(field.cells(), params.arm_length_m / resolution_m,
                          params.dilation_m / resolution_m);
  const double square_cells = std::max(params.candidate_spacing_m / resolution_m, 1.0);
  std::map<std::array<int, 3>, Candidate>
      best_of_square;  // ordered: the same map always gives the same answer
  for (int row = 0; row < geometry.rows; row += 2) {
    for (int col = 0; col < geometry.cols; col += 2) {
      if (!searcher.dilated(col, row)) continue;
      const unsigned bits = searcher.orientations(col, row);
      const unsigned corners = bits & (bits >> kRightAngle | bits << (kDirections - kRightAngle));
      for (int d = 0; corners >> d != 0; ++d) {
        if ((corners >> d & 1u) == 0) continue;
        const Eigen::Vector2d at = geometry.centreOf({col, row});
        const Candidate candidate{searcher.meanDistance(col, row, d),
                                  {at.x(), at.y(), wrapAngle(2 * M_PI * d / kDirections)}};
        const std::array<int, 3> square{static_cast<int>(row / square_cells),
                                        static_cast<int>(col / square_cells), d};
        const auto [place, is_new] = best_of_square.try_emplace(square, candidate);
        if (!is_new && candidate.mean_distance_cells < place->second.mean_distance_cells)
          place->second = candidate;
      }
    }
  }
  std::vector<Candidate> candidates;
  for (const auto& entry : best_of_square) candidates.push_back(entry.second);
  suppressDoubles(candidates, 1.5 * params.candidate_spacing_m);
  std::vector<Pose2> poses;
  for (const Candidate& candidate : candidates) poses.push_back(candidate.pose);
  return poses;
}

}  // namespace cornerstone
