#include "cornerstone/landmarks/edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>

#include "cornerstone/landmarks/edge_index.h"
#include "cornerstone/landmarks/surface_edges.h"

namespace cornerstone {
namespace {

constexpr std::array<Cell, 4> kNeighbours{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
constexpr int kNormalRadiusCells = 3;     // sees past one-cell walls and staircases
constexpr double kSameWallCosine = 0.80;  // 37 degrees: one wall's cells, not the next wall's

// A cell that leans towards occupied or free without being certain takes the state of a certain neighbour
// that leans the same way, step by step. `front`: certain cells beside such cells.
void growCertain(const cv::Mat1f& occupied, cv::Mat1b& states, std::vector<Cell>& front) {
  while (!front.empty()) {
    const Cell cell = front.back();
    front.pop_back();
    const unsigned char state = states(cell.row, cell.col);
    for (const Cell step : kNeighbours) {
      const int col = cell.col + step.col, row = cell.row + step.row;
      if (col < 0 || row < 0 || col >= states.cols || row >= states.rows) continue;
      if (states(row, col) != kUnknownCell) continue;
      const float probability = occupied(row, col);
      if (state == kOccupiedCell ? probability > kUnseen : probability < kUnseen) {
        states(row, col) = state;
        front.push_back({col, row});
      }
    }
  }
}

std::vector<Cell> certainBesideUncertain(const cv::Mat1f& occupied, const cv::Mat1b& states) {
  std::vector<Cell> front;
  for (int row = 0; row < states.rows; ++row) {
    for (int col = 0; col < states.cols; ++col) {
      if (states(row, col) != kUnknownCell || occupied(row, col) == kUnseen) continue;
      for (const Cell step : kNeighbours) {
        const int c = col + step.col, r = row + step.row;
        if (c < 0 || r < 0 || c >= states.cols || r >= states.rows) continue;
        if (states(r, c) != kUnknownCell) front.push_back({c, r});
      }
    }
  }
  return front;
}

// Sums over a square of cells, free ones counted +1 and occupied ones -1: seven cells of a row at a time, as
// the bytes of a word. The highest byte of a product is the sum of the bytes, each times the factor's byte
// opposite to it.
class FreeSide {
 public:
  explicit FreeSide(const cv::Mat1b& states) {
    cv::copyMakeBorder(states, padded_, kNormalRadiusCells, kNormalRadiusCells, kNormalRadiusCells,
                       kNormalRadiusCells + 1, cv::BORDER_CONSTANT, cv::Scalar(kUnknownCell));
  }

  // Unit vector towards free space around a cell; zero where free and occupied balance.
  Eigen::Vector2d around(Cell cell) const {
    int x = 0, y = 0;
    for (int r = 0; r <= 2 * kNormalRadiusCells; ++r) {
      std::uint64_t cells = 0;
      std::memcpy(&cells, padded_[cell.row + r] + cell.col, sizeof(cells));
      const std::uint64_t free = cells & kSevenOnes, occupied = cells >> 1 & kSevenOnes;
      const int balance = top(free * kOnes) - top(occupied * kOnes);
      x += top(free * kColumns) - top(occupied * kColumns) - kNormalRadiusCells * balance;
      y += balance * (r - kNormalRadiusCells);
    }
    const Eigen::Vector2d sum(x, y);
    return x != 0 || y != 0 ? sum.normalized() : sum;
  }

 private:
  static_assert(kNormalRadiusCells == 3, "seven cells and a spare one fill a word");
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the first cell is the lowest byte");
  static constexpr std::uint64_t kOnes = 0x0101010101010101, kSevenOnes = 0x0001010101010101;
  static constexpr std::uint64_t kColumns = 0x0001020304050600;
  static int top(std::uint64_t product) { return static_cast<int>(product >> 56); }

  cv::Mat1b padded_;
};

// The first occupied cell of a row from a column on; the row's end: none.
int nextOccupied(const cv::Mat1b& states, int row, int col) {
  const unsigned char* const first = states[row];
  const void* found = std::memchr(first + col, kOccupiedCell, static_cast<std::size_t>(states.cols - col));
  return found == nullptr ? states.cols : static_cast<int>(static_cast<const unsigned char*>(found) - first);
}

// One edge for each face between an occupied and a free cell, where the probability crosses one half.
std::vector<EdgePoint> findFaces(const GridMap& map, const cv::Mat1b& states) {
  const FreeSide free_side(states);
  std::vector<EdgePoint> faces;
  faces.reserve(states.total() / 16);  // more than walls have; memory that is never written costs nothing
  for (int row = 0; row < states.rows; ++row) {
    for (int col = nextOccupied(states, row, 0); col < states.cols;
         col = nextOccupied(states, row, col + 1)) {
      for (const Cell step : kNeighbours) {
        const Cell beside{col + step.col, row + step.row};
        if (!map.geometry.contains(beside) || states(beside.row, beside.col) != kFreeCell) continue;
        const Eigen::Vector2d outward(step.col, step.row);
        const double here = map.occupied(row, col), there = map.occupied(beside.row, beside.col);
        const double share = std::clamp((here - kUnseen) / (here - there), 0.0, 1.0);
        // Seen from the free side: on a thin wall each face has its own free space.
        const Eigen::Vector2d normal = free_side.around(beside) + outward;
        const double length = normal.norm();
        faces.push_back({map.geometry.toMetres(Eigen::Vector2d(col, row) + share * outward),
                         length > 0.1 ? Eigen::Vector2d(normal / length) : outward});
      }
    }
  }
  return faces;
}

// The line through an edge's neighbours of the same wall; the edge moves onto it along its normal.
EdgePoint onLocalLine(const EdgePoint& edge, const EdgeIndex& index, double radius_m) {
  // Numbers rather than vectors: those the compiler keeps in memory, and each step then waits for the last.
  double count = 0, sum_x = 0, sum_y = 0, xx = 0, xy = 0, yy = 0;
  const double at_x = edge.position_m.x(), at_y = edge.position_m.y();
  const double normal_x = edge.normal.x(), normal_y = edge.normal.y();
  index.forEachNear(edge.position_m, radius_m, [&](const EdgePoint& other) {
    const double x = other.position_m.x() - at_x, y = other.position_m.y() - at_y;
    // A factor, not a branch: no processor foretells which neighbours count.
    const double is_near = x * x + y * y <= radius_m * radius_m ? 1 : 0;
    const double counts =
        other.normal.x() * normal_x + other.normal.y() * normal_y >= kSameWallCosine ? is_near : 0;
    const double counted_x = counts * x, counted_y = counts * y;
    count += counts;
    sum_x += counted_x;
    sum_y += counted_y;
    xx += counted_x * x;
    xy += counted_x * y;
    yy += counted_y * y;
  });
  if (count < 3) return edge;
  const Eigen::Vector2d mean(sum_x / count, sum_y / count);
  // The line's direction is half the angle of (xx - yy, 2 xy); the normal is across it.
  const Eigen::Vector2d doubled((xx - yy) / count - mean.x() * mean.x() + mean.y() * mean.y(),
                                2 * (xy / count - mean.x() * mean.y()));
  const double length = doubled.norm();
  if (length <= 0) return edge;
  const double along_x = std::sqrt(std::max(0.5 + 0.5 * doubled.x() / length, 0.0));
  const double along_y = std::sqrt(std::max(0.5 - 0.5 * doubled.x() / length, 0.0));
  Eigen::Vector2d normal(doubled.y() < 0 ? along_y : -along_y, along_x);
  if (normal.dot(edge.normal) < 0) normal = -normal;
  if (normal.dot(edge.normal) < kSameWallCosine) return edge;  // a blob, not a line
  return {edge.position_m + mean.dot(normal) * normal, normal};
}

}  // namespace

void describe(ParamVisitor& visitor, EdgeParams& params) {
  visitor.field("occupied_above", params.occupied_above);
  visitor.field("free_below", params.free_below);
  visitor.field("smoothing_m", params.smoothing_m);
}

cv::Mat1b cellStates(const GridMap& map, const EdgeParams& params) {
  cv::Mat1b states(map.occupied.size());
  const auto occupied = static_cast<float>(params.occupied_above),
             free = static_cast<float>(params.free_below);
  const int cols = states.cols;  // a byte written might change the member, for all that the compiler knows
  int uncertain = 0;
  for (int row = 0; row < states.rows; ++row) {
    const float* from = map.occupied[row];
    unsigned char* to = states[row];
    int in_row = 0;
    for (int col = 0; col < cols; ++col) {
      const float probability = from[col];
      const int is_occupied = probability > occupied, is_free = probability < free;
      to[col] = static_cast<unsigned char>(kOccupiedCell * is_occupied + kFreeCell * is_free);
      in_row += (probability != kUnseen) & !is_occupied & !is_free;
    }
    uncertain += in_row;
  }
  if (uncertain == 0) return states;
  std::vector<Cell> front = certainBesideUncertain(map.occupied, states);
  growCertain(map.occupied, states, front);
  return states;
}

std::vector<EdgePoint> findEdges(const GridMap& map, const cv::Mat1b& states, const EdgeParams& params) {
  const double radius_m = std::max(params.smoothing_m, 2 * map.geometry.resolution_m);
  const EdgeIndex index(findFaces(map, states), 0.5 * radius_m);
  std::vector<EdgePoint> edges;
  edges.reserve(index.edges().size());
  for (const EdgePoint& face : index.edges()) edges.push_back(onLocalLine(face, index, radius_m));
  return map.surface.empty() ? edges : edgesOnSurface(EdgeIndex(edges, 0.5 * radius_m), map.surface);
}

}  // namespace cornerstone
