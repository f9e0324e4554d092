#include "cornerstone/registration/evidence_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cornerstone {
namespace {

constexpr double kFreeShare = 0.5;  // of a square's cells: surely free above it, if none is occupied
constexpr int kPlaces = 4;  // of an edge within a square, in each direction: right to an eighth of a square

// What edges of each direction, at each place within a square, make the squares around them say.
class Stamps {
 public:
  explicit Stamps(float reach_squares)
      : radius(static_cast<int>(std::ceil(reach_squares))),
        width(2 * radius + 1),
        evidence_(static_cast<std::size_t>(kPlaces * kPlaces * kEvidenceDirections * width * rowBytes())) {
    std::uint8_t* to = evidence_.data();
    for (int y = 0; y < kPlaces; ++y)
      for (int x = 0; x < kPlaces; ++x)
        for (int direction = 0; direction < kEvidenceDirections; ++direction)
          for (int row = -radius; row <= radius; ++row)
            for (int col = -radius; col <= radius; ++col, to += kEvidenceDirections) {
              const float dx = static_cast<float>(col) + 0.5f - (static_cast<float>(x) + 0.5f) / kPlaces;
              const float dy = static_cast<float>(row) + 0.5f - (static_cast<float>(y) + 0.5f) / kPlaces;
              write(1 - std::sqrt(dx * dx + dy * dy) / (reach_squares + 0.5f), direction, to);
            }
  }

  int rowBytes() const { return width * kEvidenceDirections; }
  // Rows of squares, each of `width` squares of 8 directions, around the square of an edge.
  const std::uint8_t* of(const Eigen::Vector2f& place, int direction) const {
    const int x = std::min(static_cast<int>(place.x() * kPlaces), kPlaces - 1);
    const int y = std::min(static_cast<int>(place.y() * kPlaces), kPlaces - 1);
    return &evidence_[static_cast<std::size_t>(((y * kPlaces + x) * kEvidenceDirections + direction) * width *
                                               rowBytes())];
  }

  const int radius;
  const int width;

 private:
  static void write(float share, int direction, std::uint8_t* to) {
    if (share <= 0) return;
    const auto full = static_cast<int>(std::min(1.5f * share, 1.0f) * kFullEvidence);
    const int beside = full * 7 / 10;  // normals 45 degrees apart: noise, round walls
    // An edge of another direction is no agreement, but near any edge nothing is surely free.
    std::fill_n(to, kEvidenceDirections, static_cast<std::uint8_t>(kFullEvidence));
    to[direction] = static_cast<std::uint8_t>(kFullEvidence + full);
    for (const int turn : {1, kEvidenceDirections - 1})
      to[(direction + turn) % kEvidenceDirections] = static_cast<std::uint8_t>(kFullEvidence + beside);
  }

  std::vector<std::uint8_t> evidence_;
};

}  // namespace

EvidenceGrid::EvidenceGrid(SquareCounts counts, const std::vector<EdgePoint>& edges, double reach_m)
    : counts_(std::move(counts)),
      per_square_(static_cast<float>(1 / counts_.square_m)),
      table_((counts_.free.size() + 1) * kEvidenceDirections, static_cast<std::uint8_t>(kFullEvidence)) {
  markFree();
  addEdges(edges, static_cast<float>(reach_m / counts_.square_m));
}

void EvidenceGrid::markFree() {
  // Cells larger than the squares leave squares without a cell's centre: one known cell is enough there.
  const double enough = std::max(kFreeShare * counts_.cells_per_square, 1.0);
  for (std::size_t s = 0; s < counts_.free.size(); ++s)
    if (counts_.occupied[s] == 0 && counts_.free[s] >= enough)
      std::fill_n(&table_[s * kEvidenceDirections], kEvidenceDirections, std::uint8_t{0});
}

void EvidenceGrid::addEdges(const std::vector<EdgePoint>& edges, float reach_squares) {
  const Stamps stamps(reach_squares);
  for (const EdgePoint& edge : edges) {
    const Eigen::Vector2f at = (edge.position_m.cast<float>() - counts_.origin_m) * per_square_;
    const int col = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
    const int left = std::max(col - stamps.radius, 0),
              right = std::min(col + stamps.radius, counts_.cols - 1);
    if (left > right) continue;
    const Eigen::Vector2f place = at - Eigen::Vector2f(static_cast<float>(col), static_cast<float>(row));
    const std::uint8_t* stamp =
        stamps.of(place, directionOf8(edge.normal)) + (left - col + stamps.radius) * kEvidenceDirections;
    const int bytes = (right - left + 1) * kEvidenceDirections;
    for (int r = std::max(row - stamps.radius, 0); r <= std::min(row + stamps.radius, counts_.rows - 1);
         ++r) {
      std::uint8_t* to = &table_[static_cast<std::size_t>((r * counts_.cols + left) * kEvidenceDirections)];
      const std::uint8_t* from = stamp + (r - row + stamps.radius) * stamps.rowBytes();
      for (int i = 0; i < bytes; ++i) to[i] = std::max(to[i], from[i]);
    }
  }
}

std::vector<Opinion> EvidenceGrid::opinions() const {
  std::vector<Opinion> opinions;
  for (int r = 0; r < counts_.rows; ++r) {
    for (int c = 0; c < counts_.cols; ++c) {
      const std::uint8_t* square =
          &table_[static_cast<std::size_t>((r * counts_.cols + c) * kEvidenceDirections)];
      const int best = *std::max_element(square, square + kEvidenceDirections) - kFullEvidence;
      if (best == 0) continue;
      const Eigen::Vector2f middle(static_cast<float>(c) + 0.5f, static_cast<float>(r) + 0.5f);
      opinions.push_back({counts_.origin_m + middle * static_cast<float>(counts_.square_m), best});
    }
  }
  return opinions;
}

}  // namespace cornerstone
