#include "beam_evidence.h"

#include <algorithm>
#include <cmath>

namespace cornerstone {
namespace {
constexpr double kReachSigmas = 3.5;  // of the interval in which the surface is looked for
}

BeamEvidence::BeamEvidence(const Beam& beam, const CellWindow& window, const OccupancyGrid& grid)
    : beam_(beam), window_(window), grid_(grid), step_m_(grid.params().resolution_m / 2) {
  const double cell_variance = std::pow(grid.params().resolution_m, 2) / 12;
  sigma_m_ = std::sqrt(beam.sigma_m * beam.sigma_m + cell_variance);
  sigma_near_m_ = std::sqrt(std::pow((beam.range_m - beam.near_m) / 2, 2) + cell_variance);
  sigma_far_m_ = std::sqrt(std::pow((beam.far_m - beam.range_m) / 2, 2) + cell_variance);
  start_m_ = std::max(0.0, beam.range_m - kReachSigmas * sigma_near_m_);
  end_m_ = std::min(beam.range_m + kReachSigmas * sigma_far_m_, grid.params().max_range_m + step_m_);
  if (beam.sigma_m > grid.params().max_sigma_m) end_m_ = std::min(end_m_, start_m_);
}

double BeamEvidence::density(double range_m) const {
  const double off_m = range_m - beam_.range_m;
  const double sigma = off_m < 0 ? sigma_near_m_ : sigma_far_m_;
  const double mean_sigma = (sigma_near_m_ + sigma_far_m_) / 2;
  return std::exp(-0.5 * off_m * off_m / (sigma * sigma)) / (std::sqrt(2 * M_PI) * mean_sigma);
}

void BeamEvidence::trace(const Eigen::Vector2d& origin_m, double heading_rad) {
  const Eigen::Vector2d direction(std::cos(heading_rad), std::sin(heading_rad));
  point_m_ = origin_m + beam_.range_m * direction;
  transmission_.clear();
  behind_.clear();
  std::vector<float> cause;
  double transmission = 1, total = 0;
  const double last_m = beam_.range_m + kReachSigmas * sigma_far_m_;
  for (double range_m = start_m_ + step_m_ / 2; range_m < last_m; range_m += step_m_) {
    const Cell cell = window_.geometry.cellAt(origin_m + range_m * direction);
    const double occupied =
        grid_.scale().occupied(window_.geometry.contains(cell) ? window_.at(cell) : EvidenceCell{0});
    const double hazard = 1 - std::sqrt(1 - occupied);  // a step is half a cell
    transmission_.push_back(static_cast<float>(transmission));
    cause.push_back(static_cast<float>(hazard * transmission * density(range_m)));
    total += cause.back();
    transmission *= 1 - hazard;
  }
  double before = 0;
  for (const float part : cause) {
    behind_.push_back(static_cast<float>(before / total));
    before += part;
  }
  normaliser_ = total;
  const double mismatch = grid_.params().outlier_ratio / grid_.params().max_range_m;  // even along the beam
  outlier_ = mismatch / (mismatch + (1 - grid_.params().outlier_ratio) * total);
}

double BeamEvidence::causeOf(double range_m, double occupied) const {
  const double from_start = (range_m - start_m_) / step_m_ - 1;  // step that ends where the cell begins
  const auto step = static_cast<std::size_t>(std::max(0.0, from_start));
  if (step >= transmission_.size()) return 0;
  const double cause = occupied * transmission_[step] * density(range_m) / normaliser_;
  return std::min(cause, 1.0 - behind_[step]);
}

double BeamEvidence::behindOf(double range_m) const {
  const double from_start = (range_m - start_m_) / step_m_ - 1;
  if (from_start <= 0) return 0;
  const auto step = static_cast<std::size_t>(from_start);
  return step < behind_.size() ? behind_[step] : 1;
}

double BeamEvidence::posteriorOf(double range_m, double occupied) const {
  const double known = causeOf(range_m, occupied) + behindOf(range_m) * occupied;
  return (1 - outlier_) * known + outlier_ * occupied;
}

}  // namespace cornerstone
