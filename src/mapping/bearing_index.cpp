#include "cornerstone/mapping/bearing_index.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

// Way along the square |x| + |y| = 1: rises with the bearing, from -2 at -pi to 2 at pi.
double wayOf(const Eigen::Vector2d& direction) {
  const double size = std::abs(direction.x()) + std::abs(direction.y());
  if (size == 0) return 0;
  const double across = direction.y() / size;
  if (direction.x() >= 0) return across;
  return direction.y() < 0 ? -2 - across : 2 - across;
}

double wayOf(double bearing_rad) {
  return wayOf(Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)));
}

}  // namespace

BearingIndex::BearingIndex(const std::vector<double>& bearings_rad) {
  if (bearings_rad.empty()) return;
  limits_.reserve(bearings_rad.size() + 1);
  limits_.push_back(wayOf(bearings_rad.front()));
  for (std::size_t i = 1; i < bearings_rad.size(); ++i)
    limits_.push_back(wayOf((bearings_rad[i - 1] + bearings_rad[i]) / 2));
  limits_.push_back(wayOf(bearings_rad.back()));
}

std::optional<std::size_t> BearingIndex::nearest(const Eigen::Vector2d& in_sensor_m, std::size_t near) const {
  const double way = wayOf(in_sensor_m);
  if (limits_.empty() || way < limits_.front() || way > limits_.back()) return std::nullopt;
  const std::size_t last = limits_.size() - 2;
  std::size_t beam = std::min(near, last);
  while (beam < last && way >= limits_[beam + 1]) ++beam;
  while (beam > 0 && way < limits_[beam]) --beam;
  return beam;
}

}  // namespace cornerstone
