#include "column_surface.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {

// Nearest first.
class NearestPixels {
 public:
  explicit NearestPixels(std::vector<ColumnPixel>& pixels) : pixels_(pixels) {}
  const ColumnPixel& operator[](std::size_t i) {
    if (i >= sorted_) sortTo(i);
    return pixels_[i];
  }
  // First index from which `count` pixels lie within a window of agreement; size() when there is none.
  std::size_t firstAgreeing(int count, double agree_sigmas) {
    const auto needed = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i + needed <= pixels_.size(); ++i) {
      const ColumnPixel &last = (*this)[i + needed - 1], &first = pixels_[i];
      if (first.q - last.q <= agree_sigmas * (first.sigma_q + last.sigma_q)) return i;
    }
    return pixels_.size();
  }

 private:
  // As a rule the nearest few agree: the others need no order.
  void sortTo(std::size_t i) {
    const std::size_t to = std::min(pixels_.size(), std::max(i + 1, 2 * sorted_));
    const auto at = [&](std::size_t k) { return pixels_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::partial_sort(at(sorted_), at(to), pixels_.end(),
                      [](const auto& a, const auto& b) { return a.q > b.q; });
    sorted_ = to;
  }
  std::vector<ColumnPixel>& pixels_;
  std::size_t sorted_ = 0;
};

struct WeightedMean {
  double weight = 0;
  double q = 0;
  double scatter = 0;  // weighted variance of the pixels
  double row = 0;
  int count = 0;
};

WeightedMean meanAround(const std::vector<ColumnPixel>& pixels, double q, double agree_sigmas) {
  WeightedMean mean;
  double squares = 0;
  for (const ColumnPixel& pixel : pixels) {
    if (std::abs(pixel.q - q) > agree_sigmas * pixel.sigma_q) continue;
    const double weighted = pixel.weight * pixel.q;
    mean.weight += pixel.weight;
    mean.q += weighted;
    squares += weighted * pixel.q;
    mean.row += pixel.weight * pixel.row;
    ++mean.count;
  }
  if (mean.count == 0) return mean;
  mean.q /= mean.weight;
  mean.scatter = std::max(0.0, squares / mean.weight - mean.q * mean.q);
  mean.row /= mean.weight;
  return mean;
}

}  // namespace

std::optional<ColumnSurface> nearestSurface(std::vector<ColumnPixel>& pixels, const ColumnRays& rays,
                                            double common_sigma, const ScanParams& params) {
  NearestPixels nearest(pixels);
  const std::size_t first = nearest.firstAgreeing(params.min_support_px, params.agree_sigmas);
  if (first == pixels.size()) return std::nullopt;

  // The first window is the near tail of the surface's noise: move on to the middle of all that agree.
  double q = nearest[first + static_cast<std::size_t>(params.min_support_px) / 2].q;
  WeightedMean mean;
  constexpr int kMaxMoves = 8;
  for (int i = 0; i < kMaxMoves; ++i) {
    mean = meanAround(pixels, q, params.agree_sigmas);
    if (mean.count < params.min_support_px) return std::nullopt;
    if (std::abs(mean.q - q) < 1e-6) break;
    q = mean.q;
  }
  const double independent = std::max(1.0, mean.count / params.correlated_px);
  const double one = std::max(mean.count / mean.weight, mean.scatter);
  const Eigen::Vector2d direction = rays.of(mean.row);
  const double common = common_sigma / direction.norm();

  ColumnSurface surface;
  surface.q = mean.q;
  surface.sigma_q = std::sqrt(one / independent + common * common);
  surface.direction = direction;
  const std::size_t caution = nearest.firstAgreeing(params.min_caution_px, params.agree_sigmas);
  // There may be none where fewer pixels than an obstacle needs are nearly as many.
  surface.caution_q = caution < pixels.size() ? std::max(mean.q, pixels[caution].q) : mean.q;
  // What lies within the surface's own noise is the surface, not something before it.
  if (surface.caution_q - mean.q <= params.agree_sigmas * std::sqrt(one)) surface.caution_q = mean.q;
  return surface;
}

}  // namespace cornerstone
