#include "cornerstone/registration/thin_edges.h"

#include <cmath>
#include <cstdint>
#include <random>

namespace cornerstone {
namespace {

constexpr double kTan22_5 = 0.41421356237309503;

// Finds the place of a key, in the order in which the keys came first.
class Places {
 public:
  explicit Places(std::size_t most) {
    std::size_t slots = 64;
    while (slots < 2 * most) slots *= 2;
    slots_.resize(slots);
  }
  std::size_t of(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>(key * 0x9E3779B97F4A7C15 >> 32) & mask;  // Fibonacci hashing
    while (slots_[slot] != 0 && keys_[slots_[slot] - 1] != key) slot = (slot + 1) & mask;
    if (slots_[slot] == 0) {
      keys_.push_back(key);
      slots_[slot] = static_cast<std::uint32_t>(keys_.size());
    }
    return slots_[slot] - 1;
  }

 private:
  std::vector<std::uint32_t> slots_;  // places, from 1 on; 0: empty
  std::vector<std::uint64_t> keys_;   // by place
};

std::uint64_t keyOf(const EdgePoint& edge, double square_m) {
  const auto col = static_cast<std::int64_t>(std::floor(edge.position_m.x() / square_m));
  const auto row = static_cast<std::int64_t>(std::floor(edge.position_m.y() / square_m));
  return (static_cast<std::uint64_t>(row) << 32 | (static_cast<std::uint64_t>(col) & 0xFFFFFFFF)) * 8 +
         static_cast<std::uint64_t>(directionOf8(edge.normal));
}

}  // namespace

int directionOf8(const Eigen::Vector2d& normal) {
  const double x = std::abs(normal.x()), y = std::abs(normal.y());
  const int octant = y < kTan22_5 * x ? 0 : x < kTan22_5 * y ? 2 : 1;  // of the first quadrant
  const int half = normal.x() >= 0 ? octant : 4 - octant;
  return normal.y() >= 0 ? half : (8 - half) % 8;
}

std::vector<EdgePoint> thinEdges(const std::vector<EdgePoint>& edges, double square_m) {
  Places places(edges.size());
  std::vector<EdgePoint> sums;
  std::vector<int> counts;
  for (const EdgePoint& edge : edges) {
    const std::size_t place = places.of(keyOf(edge, square_m));
    if (place == sums.size()) {
      sums.push_back(edge);
      counts.push_back(1);
      continue;
    }
    sums[place].position_m += edge.position_m;
    sums[place].normal += edge.normal;
    ++counts[place];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i].position_m /= counts[i];
    sums[i].normal.normalize();
  }
  std::mt19937 order(1);
  for (std::size_t i = sums.size(); i > 1; --i) std::swap(sums[i - 1], sums[order() % i]);
  return sums;
}

EdgeSamples samplesOf(const std::vector<EdgePoint>& edges) {
  EdgeSamples samples;
  for (const EdgePoint& edge : edges) {
    const double turns_256 = std::atan2(edge.normal.y(), edge.normal.x()) * 128 / M_PI;
    samples.add(edge.position_m.cast<float>(), static_cast<int>(std::lround(turns_256)) & 255);
  }
  return samples;
}

}  // namespace cornerstone
