#include "cornerstone/landmarks/edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "cornerstone/landmarks/edge_index.h"

namespace cornerstone {
namespace {

constexpr std::array<Cell, 4> kNeighbours{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
constexpr int kNormalRadiusCells = 3;     // sees past one-cell walls and staircases
constexpr double kSameWallCosine = 0.80;  // 37 degrees: one wall's cells, not the next wall's

// Certain cells hand their state to uncertain neighbours that lean the same way, step by step.
void growCertain(const GridMap& map, cv::Mat1b& states, std::deque<Cell>& front) {
  while (!front.empty()) {
    const Cell cell = front.front();
    front.pop_front();
    const unsigned char state = states(cell.row, cell.col);
    for (const Cell step : kNeighbours) {
      const Cell next{cell.col + step.col, cell.row + step.row};
      if (!map.geometry.contains(next) || states(next.row, next.col) != kUnknownCell) continue;
      const float probability = map.occupied(next.row, next.col);
      if (state == kOccupiedCell ? probability > kUnseen : probability < kUnseen) {
        states(next.row, next.col) = state;
        front.push_back(next);
      }
    }
  }
}

// Unit vector towards free space around a cell; zero where free and occupied balance.
Eigen::Vector2d towardsFree(const cv::Mat1b& states, Cell cell) {
  static constexpr std::array<int, 3> kWeight{0, 1, -1};  // by CellState
  const int first = std::max(cell.col - kNormalRadiusCells, 0);
  const int last = std::min(cell.col + kNormalRadiusCells, states.cols - 1);
  int x = 0, y = 0;
  for (int r = std::max(cell.row - kNormalRadiusCells, 0);
       r <= std::min(cell.row + kNormalRadiusCells, states.rows - 1); ++r) {
    const unsigned char* row = states[r];
    int in_row = 0;
    for (int c = first; c <= last; ++c) {
      const int weight = kWeight[row[c]];
      x += weight * (c - cell.col);
      in_row += weight;
    }
    y += in_row * (r - cell.row);
  }
  const Eigen::Vector2d sum(x, y);
  return x != 0 || y != 0 ? sum.normalized() : sum;
}

// One edge for each face between an occupied and a free cell, where the probability crosses one half.
std::vector<EdgePoint> findFaces(const GridMap& map, const cv::Mat1b& states) {
  std::vector<EdgePoint> faces;
  for (int row = 0; row < states.rows; ++row) {
    const unsigned char* state = states[row];
    for (int col = 0; col < states.cols; ++col) {
      if (state[col] != kOccupiedCell) continue;
      for (const Cell step : kNeighbours) {
        const Cell beside{col + step.col, row + step.row};
        if (!map.geometry.contains(beside) || states(beside.row, beside.col) != kFreeCell) continue;
        const Eigen::Vector2d outward(step.col, step.row);
        const double here = map.occupied(row, col), there = map.occupied(beside.row, beside.col);
        const double share = std::clamp((here - kUnseen) / (here - there), 0.0, 1.0);
        // Seen from the free side: on a thin wall each face has its own free space.
        const Eigen::Vector2d normal = towardsFree(states, beside) + outward;
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
  double count = 0;
  Eigen::Vector2d sum(0, 0);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  index.forEachNear(edge.position_m, [&](int i) {
    const EdgePoint& other = index.edges()[static_cast<std::size_t>(i)];
    const Eigen::Vector2d offset = other.position_m - edge.position_m;
    if (offset.squaredNorm() > radius_m * radius_m || other.normal.dot(edge.normal) < kSameWallCosine) return;
    ++count;
    sum += offset;
    squares += offset * offset.transpose();
  });
  if (count < 3) return edge;
  const Eigen::Vector2d mean = sum / count;
  const Eigen::Matrix2d spread = squares / count - mean * mean.transpose();
  const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));  // of the line
  Eigen::Vector2d normal(-std::sin(angle), std::cos(angle));
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
  cv::Mat1b states(map.occupied.size(), static_cast<unsigned char>(kUnknownCell));
  const float occupied = static_cast<float>(params.occupied_above),
              free = static_cast<float>(params.free_below);
  bool uncertain = false;
  for (int row = 0; row < states.rows; ++row) {
    const float* from = map.occupied[row];
    unsigned char* to = states[row];
    for (int col = 0; col < states.cols; ++col) {
      const float probability = from[col];
      to[col] = probability > occupied ? kOccupiedCell : probability < free ? kFreeCell : kUnknownCell;
      uncertain |= to[col] == kUnknownCell && probability != kUnseen;
    }
  }
  if (!uncertain) return states;
  std::deque<Cell> front;
  for (int row = 0; row < states.rows; ++row)
    for (int col = 0; col < states.cols; ++col)
      if (states(row, col) != kUnknownCell) front.push_back({col, row});
  growCertain(map, states, front);
  return states;
}

std::vector<EdgePoint> findEdges(const GridMap& map, const cv::Mat1b& states, const EdgeParams& params) {
  const std::vector<EdgePoint> faces = findFaces(map, states);
  const double radius_m = std::max(params.smoothing_m, 2 * map.geometry.resolution_m);
  const EdgeIndex index(faces, radius_m);
  std::vector<EdgePoint> edges;
  edges.reserve(faces.size());
  for (const EdgePoint& face : faces) edges.push_back(onLocalLine(face, index, radius_m));
  return edges;
}

}  // namespace cornerstone
