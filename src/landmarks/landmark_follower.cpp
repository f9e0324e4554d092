#include "cornerstone/landmarks/landmark_follower.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "cornerstone/landmarks/crop.h"

namespace cornerstone {
namespace {

constexpr double kEdgeReach_m =
    0.5;                           // around a changed cell edges may change: normals, then lines through them
constexpr double kTurn_rad = 0.5;  // a corner that turns more is another one

// Whole cells from the first map's origin to the second's; empty: their cells do not lie on one grid.
std::optional<cv::Point> offsetInCells(const GridGeometry& from, const GridGeometry& to) {
  if (from.resolution_m != to.resolution_m) return std::nullopt;
  const double x = (to.origin_x_m - from.origin_x_m) / from.resolution_m;
  const double y = (to.origin_y_m - from.origin_y_m) / from.resolution_m;
  if (std::abs(x - std::round(x)) > 1e-3 || std::abs(y - std::round(y)) > 1e-3) return std::nullopt;
  return cv::Point(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
}

// Around all cells that differ, those of the old map that the new one lacks left out.
cv::Rect changedCells(const GridMap& before, const GridMap& now, const cv::Point& now_in_before) {
  int left = now.geometry.cols, right = -1, bottom = now.geometry.rows, top = -1;
  std::vector<float> unseen(static_cast<std::size_t>(now.geometry.cols), kUnseen), old(unseen);
  for (int row = 0; row < now.geometry.rows; ++row) {
    old = unseen;
    const int old_row = row + now_in_before.y;
    if (old_row >= 0 && old_row < before.geometry.rows) {
      const int first = std::max(now_in_before.x, 0);
      const int end = std::min(now_in_before.x + now.geometry.cols, before.geometry.cols);
      if (first < end)
        std::copy(before.occupied[old_row] + first, before.occupied[old_row] + end,
                  old.begin() + (first - now_in_before.x));
    }
    const float* cells = now.occupied[row];
    if (std::memcmp(cells, old.data(), old.size() * sizeof(float)) == 0) continue;
    const auto end = old.end();
    const auto first = std::mismatch(old.begin(), end, cells).first;
    const auto last =
        std::mismatch(old.rbegin(), old.rend(), std::reverse_iterator(cells + now.geometry.cols)).first;
    left = std::min(left, static_cast<int>(first - old.begin()));
    right = std::max(right, static_cast<int>(last.base() - old.begin()) - 1);
    bottom = std::min(bottom, row);
    top = row;
  }
  return top < 0 ? cv::Rect() : cv::Rect(left, bottom, right - left + 1, top - bottom + 1);
}

cv::Rect grown(const cv::Rect& cells, int by, const GridGeometry& within) {
  const cv::Rect all(0, 0, within.cols, within.rows);
  return cv::Rect(cells.x - by, cells.y - by, cells.width + 2 * by, cells.height + 2 * by) & all;
}

// Takes what lies in a region from `fresh` and everything else from `kept`.
template <typename Item, typename PlaceOf>
std::vector<Item> patched(const std::vector<Item>& kept, const std::vector<Item>& fresh,
                          const PlaceOf& isInside) {
  std::vector<Item> items;
  items.reserve(kept.size() + fresh.size());
  std::copy_if(kept.begin(), kept.end(), std::back_inserter(items),
               [&](const Item& i) { return !isInside(i); });
  std::copy_if(fresh.begin(), fresh.end(), std::back_inserter(items), isInside);
  return items;
}

bool isIn(const cv::Rect& cells, const GridGeometry& geometry, const Eigen::Vector2d& point_m) {
  const Cell cell = geometry.cellAt(point_m);
  return cells.contains(cv::Point(cell.col, cell.row));
}

}  // namespace

void LandmarkFollower::searchAll(const GridMap& map) {
  landmarks_ = detectLandmarks(map, params_);
  searched_share_ = 1;
}

void LandmarkFollower::searchAround(const GridMap& map, const cv::Rect& changed) {
  const auto cells = [&](double metres) {
    return static_cast<int>(std::ceil(metres / map.geometry.resolution_m));
  };
  const cv::Rect edges = grown(changed, cells(kEdgeReach_m), map.geometry);
  const cv::Rect corners = grown(edges, cells(params_.arm_length_m + params_.suppression_m), map.geometry);
  cv::Rect searched = grown(corners, cells(params_.arm_length_m + params_.suppression_m), map.geometry);
  // Candidates are looked for in squares and on every other cell: those of the whole map.
  const int step = 2 * std::max(cells(params_.candidate_spacing_m), 1);
  searched = aligned(searched, step);
  const Landmarks fresh = detectLandmarks(cropped(map, searched), params_);
  fresh.states(edges - searched.tl()).copyTo(landmarks_.states(edges));
  landmarks_.edges = patched(landmarks_.edges, fresh.edges, [&](const EdgePoint& e) {
    // Many edges lie on the border between two cells, to the last digit.
    return isIn(edges, map.geometry,
                e.position_m + Eigen::Vector2d::Constant(1e-3 * map.geometry.resolution_m));
  });
  landmarks_.corners = patched(landmarks_.corners, fresh.corners, [&](const CornerLandmark& c) {
    return isIn(corners, map.geometry, c.pose.translation());
  });
  landmarks_.corners =
      suppressNear(std::move(landmarks_.corners), params_.suppression_m);  // across the border
  searched_share_ = static_cast<double>(searched.area()) / std::max(map.geometry.cols * map.geometry.rows, 1);
}

void LandmarkFollower::dropOutside(const GridGeometry& geometry) {
  const cv::Rect all(0, 0, geometry.cols, geometry.rows);
  const auto drop = [&](auto& items, const auto& placeOf) {
    items.erase(std::remove_if(items.begin(), items.end(),
                               [&](const auto& item) { return !isIn(all, geometry, placeOf(item)); }),
                items.end());
  };
  drop(landmarks_.edges, [](const EdgePoint& e) { return e.position_m; });
  drop(landmarks_.corners, [](const CornerLandmark& c) { return c.pose.translation(); });
}

// Corners that were found anew take the identity of the nearest one of their kind that stood there before.
void LandmarkFollower::keepIdentities(const std::vector<CornerLandmark>& before, double time_s) {
  std::vector<bool> taken(before.size());
  for (CornerLandmark& corner : landmarks_.corners) {
    if (corner.id != 0) continue;
    double nearest_m = 0.5 * params_.suppression_m;  // two corners of a kind are never this near
    std::size_t best = before.size();
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double distance_m = (before[i].pose.translation() - corner.pose.translation()).norm();
      if (taken[i] || before[i].kind != corner.kind || distance_m > nearest_m ||
          std::abs(wrapAngle(before[i].pose.yaw_rad - corner.pose.yaw_rad)) > kTurn_rad)
        continue;
      nearest_m = distance_m;
      best = i;
    }
    if (best < before.size()) {
      taken[best] = true;
      corner.id = before[best].id;
      corner.looks = before[best].looks + 1;
      corner.since_s = before[best].since_s;
    } else {
      corner.id = ++last_id_;
      corner.since_s = time_s;
    }
  }
}

const Landmarks& LandmarkFollower::update(const GridMap& map, double time_s) {
  const std::vector<CornerLandmark> before = landmarks_.corners;
  const auto offset = offsetInCells(map_.geometry, map.geometry);
  if (map_.occupied.empty() || map.occupied.empty() || !offset) {
    searchAll(map);
  } else {
    const cv::Rect changed = changedCells(map_, map, *offset);
    cv::Mat1b states(map.occupied.size(), static_cast<unsigned char>(kUnknownCell));
    const cv::Rect old_in_new = cv::Rect(-offset->x, -offset->y, map_.geometry.cols, map_.geometry.rows) &
                                cv::Rect(0, 0, map.geometry.cols, map.geometry.rows);
    if (!old_in_new.empty()) landmarks_.states(old_in_new + *offset).copyTo(states(old_in_new));
    landmarks_.states = states;
    dropOutside(map.geometry);
    searched_share_ = 0;
    if (!changed.empty()) searchAround(map, changed);
  }
  keepIdentities(before, time_s);
  map_.geometry = map.geometry;
  map_.occupied = map.occupied;  // nobody writes into a snapshot
  return landmarks_;
}

}  // namespace cornerstone
