#include "cornerstone/registration/evidence_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace cornerstone {
namespace {

constexpr double kFreeShare = 0.5;  // of a square's cells: surely free above it, if none is occupied

int direction256(const Eigen::Vector2d& normal) {
  return static_cast<int>(std::lround(std::atan2(normal.y(), normal.x()) * 128 / M_PI)) & 255;
}
int direction8(const Eigen::Vector2d& normal) { return ((direction256(normal) + 16) & 255) >> 5; }

}  // namespace

EvidenceGrid::EvidenceGrid(const GridMap& map, const cv::Mat1b& states, const std::vector<EdgePoint>& edges,
                           double cell_m, double reach_m)
    : origin_m_(static_cast<float>(map.geometry.origin_x_m), static_cast<float>(map.geometry.origin_y_m)),
      per_cell_(static_cast<float>(1 / cell_m)),
      cols_(std::max(static_cast<int>(std::ceil(map.geometry.cols * map.geometry.resolution_m / cell_m)), 1)),
      rows_(std::max(static_cast<int>(std::ceil(map.geometry.rows * map.geometry.resolution_m / cell_m)), 1)),
      table_(static_cast<std::size_t>(cols_ * rows_ * kEvidenceDirections)),
      known_(static_cast<std::size_t>(cols_ * rows_)) {
  markFree(map, states);
  for (const EdgePoint& edge : edges) addEdge(edge, static_cast<float>(reach_m / cell_m));
}

void EvidenceGrid::markFree(const GridMap& map, const cv::Mat1b& states) {
  const double ratio = map.geometry.resolution_m * per_cell_;
  std::vector<int> column(static_cast<std::size_t>(map.geometry.cols));
  for (int c = 0; c < map.geometry.cols; ++c)
    column[static_cast<std::size_t>(c)] = std::min(static_cast<int>((c + 0.5) * ratio), cols_ - 1);
  std::vector<int> free(known_.size()), occupied(known_.size());
  for (int r = 0; r < map.geometry.rows; ++r) {
    const int base = std::min(static_cast<int>((r + 0.5) * ratio), rows_ - 1) * cols_;
    const unsigned char* state = states[r];
    for (int c = 0; c < map.geometry.cols; ++c) {
      if (state[c] == kUnknownCell) continue;
      ++(state[c] == kFreeCell
             ? free
             : occupied)[static_cast<std::size_t>(base + column[static_cast<std::size_t>(c)])];
    }
  }
  // Cells larger than the squares leave squares without a cell's centre: one known cell is enough there.
  const double enough = std::max(kFreeShare / (ratio * ratio), 1.0);
  for (std::size_t s = 0; s < known_.size(); ++s) {
    known_[s] = static_cast<std::uint8_t>(std::min(free[s] + occupied[s], 255));
    if (occupied[s] == 0 && free[s] >= enough)
      std::fill_n(table_.begin() + static_cast<std::ptrdiff_t>(s * kEvidenceDirections), kEvidenceDirections,
                  static_cast<std::int8_t>(-kFullEvidence));
  }
}

void EvidenceGrid::addEdge(const EdgePoint& edge, float reach_cells) {
  const Eigen::Vector2f at = (edge.position_m.cast<float>() - origin_m_) * per_cell_;
  const int direction = direction8(edge.normal);
  const int first_row = std::max(static_cast<int>(at.y() - reach_cells), 0);
  const int last_row = std::min(static_cast<int>(at.y() + reach_cells), rows_ - 1);
  const int first_col = std::max(static_cast<int>(at.x() - reach_cells), 0);
  const int last_col = std::min(static_cast<int>(at.x() + reach_cells), cols_ - 1);
  for (int r = first_row; r <= last_row; ++r) {
    for (int c = first_col; c <= last_col; ++c) {
      const float dx = static_cast<float>(c) + 0.5f - at.x(), dy = static_cast<float>(r) + 0.5f - at.y();
      const float share = 1 - std::sqrt(dx * dx + dy * dy) / (reach_cells + 0.5f);
      if (share <= 0) continue;
      const auto full = static_cast<std::int8_t>(std::min(1.5f * share, 1.0f) * kFullEvidence);
      const auto beside =
          static_cast<std::int8_t>(full * 7 / 10);  // normals 45 degrees apart: noise, round walls
      std::int8_t* cell = &table_[static_cast<std::size_t>((r * cols_ + c) * kEvidenceDirections)];
      // An edge of another direction is no agreement, but near any edge nothing is surely free.
      for (int d = 0; d < kEvidenceDirections; ++d) cell[d] = std::max(cell[d], std::int8_t{0});
      cell[direction] = std::max(cell[direction], full);
      cell[(direction + 1) & 7] = std::max(cell[(direction + 1) & 7], beside);
      cell[(direction + 7) & 7] = std::max(cell[(direction + 7) & 7], beside);
    }
  }
}

bool EvidenceGrid::known(const Eigen::Vector2f& point_m) const {
  const Eigen::Vector2f at = (point_m - origin_m_) * per_cell_;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < static_cast<float>(cols_) &&
        at.y() < static_cast<float>(rows_)))
    return false;
  return known_[static_cast<std::size_t>(static_cast<int>(at.y()) * cols_ + static_cast<int>(at.x()))] > 0;
}

std::vector<Eigen::Vector2f> EvidenceGrid::knownSquares() const {
  std::vector<Eigen::Vector2f> squares;
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < cols_; ++c)
      if (known_[static_cast<std::size_t>(r * cols_ + c)] > 0)
        squares.push_back(origin_m_ +
                          Eigen::Vector2f(static_cast<float>(c) + 0.5f, static_cast<float>(r) + 0.5f) /
                              per_cell_);
  return squares;
}

std::vector<Opinion> EvidenceGrid::opinions() const {
  std::vector<Opinion> opinions;
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < cols_; ++c) {
      const std::int8_t* cell = &table_[static_cast<std::size_t>((r * cols_ + c) * kEvidenceDirections)];
      const int best = *std::max_element(cell, cell + kEvidenceDirections);
      if (best == 0) continue;
      const Eigen::Vector2f middle(static_cast<float>(c) + 0.5f, static_cast<float>(r) + 0.5f);
      opinions.push_back({origin_m_ + middle / per_cell_, best});
    }
  }
  return opinions;
}

std::vector<EdgePoint> thinEdges(const std::vector<EdgePoint>& edges, double cell_m) {
  struct Keyed {
    int row, col, direction;
    std::size_t edge;
    bool operator<(const Keyed& o) const {
      return std::tie(row, col, direction, edge) < std::tie(o.row, o.col, o.direction, o.edge);
    }
  };
  std::vector<Keyed> keyed;
  keyed.reserve(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector2d at = edges[i].position_m / cell_m;
    keyed.push_back({static_cast<int>(std::floor(at.y())), static_cast<int>(std::floor(at.x())),
                     direction8(edges[i].normal), i});
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<EdgePoint> thin;
  for (std::size_t i = 0; i < keyed.size();) {
    EdgePoint mean{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    std::size_t j = i;
    for (; j < keyed.size() && keyed[j].row == keyed[i].row && keyed[j].col == keyed[i].col &&
           keyed[j].direction == keyed[i].direction;
         ++j) {
      mean.position_m += edges[keyed[j].edge].position_m;
      mean.normal += edges[keyed[j].edge].normal;
    }
    thin.push_back({mean.position_m / static_cast<double>(j - i), mean.normal.normalized()});
    i = j;
  }
  std::mt19937 order(1);
  for (std::size_t i = thin.size(); i > 1; --i) std::swap(thin[i - 1], thin[order() % i]);
  return thin;
}

std::vector<EdgeSample> samplesOf(const std::vector<EdgePoint>& edges) {
  std::vector<EdgeSample> samples;
  samples.reserve(edges.size());
  for (const EdgePoint& edge : edges)
    samples.push_back({edge.position_m.cast<float>(), direction256(edge.normal)});
  return samples;
}

}  // namespace cornerstone
