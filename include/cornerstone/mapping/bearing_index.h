// Which of a look's beams points nearest to a place. Directions are compared by a number that rises with
// their bearing but needs no arc tangent, which would take most of the time of matching two looks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace cornerstone {

class BearingIndex {
 public:
  BearingIndex() = default;
  explicit BearingIndex(const std::vector<double>& bearings_rad);  // rising, in (-pi, pi]
  // The beam nearest in bearing; none where the place lies before the first beam or after the last. It is
  // looked for from `near` on, the answer for a place beside this one.
  std::optional<std::size_t> nearest(const Eigen::Vector2d& in_sensor_m, std::size_t near) const;

 private:
  std::vector<double> limits_;  // of each beam, from which on it is the nearest; and the end of the last
};

}  // namespace cornerstone
