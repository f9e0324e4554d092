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

namespace {

// exp(-x^2 / 2) at x, x + h, x + 2 h, ...: two products a value.
class GaussSteps {
 public:
  GaussSteps(double x, double h)
      : value_(std::exp(-0.5 * x * x)), ratio_(std::exp(-h * (x + 0.5 * h))), change_(std::exp(-h * h)) {}
  double next() {
    const double value = value_;
    value_ *= ratio_;
    ratio_ *= change_;
    return value;
  }

 private:
  double value_, ratio_, change_;
};

}  // namespace

void BeamEvidence::trace(const Eigen::Vector2d& origin_m, double heading_rad) {
  const Eigen::Vector2d direction(std::cos(heading_rad), std::sin(heading_rad));
  point_m_ = origin_m + beam_.range_m * direction;
  const double last_m = beam_.range_m + kReachSigmas * sigma_far_m_;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil((last_m - start_m_) / step_m_ - 0.5)));
  transmission_.resize(count);
  behind_.resize(count);
  const double first_m = start_m_ + step_m_ / 2;
  const auto near = std::min(
      count, static_cast<std::size_t>(std::max(0.0, std::ceil((beam_.range_m - first_m) / step_m_))));
  const double peak = 2 / (std::sqrt(2 * M_PI) * (sigma_near_m_ + sigma_far_m_));
  GaussSteps gauss((first_m - beam_.range_m) / sigma_near_m_, step_m_ / sigma_near_m_);
  const GridGeometry& at = window_.geometry;
  const Eigen::Vector2d half_cell(0.5, 0.5), step_cells = (step_m_ / at.resolution_m) * direction;
  Eigen::Vector2d cells = at.toCells(origin_m + first_m * direction) + half_cell;
  double transmission = 1, total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double range_m = first_m + static_cast<double>(i) * step_m_;
    if (i == near) gauss = GaussSteps((range_m - beam_.range_m) / sigma_far_m_, step_m_ / sigma_far_m_);
    // Rounded down: what is negative lies outside the window.
    const Cell cell{static_cast<int>(cells.x() + 1) - 1, static_cast<int>(cells.y() + 1) - 1};
    cells += step_cells;
    const double hazard =
        grid_.scale().hazard(window_.geometry.contains(cell) ? window_.at(cell) : EvidenceCell{0});
    transmission_[i] = static_cast<float>(transmission);
    behind_[i] = static_cast<float>(total);  // divided by all of it below
    total += hazard * transmission * peak * gauss.next();
    transmission *= 1 - hazard;
  }
  const auto share = static_cast<float>(1 / total);
  for (float& before : behind_) before *= share;
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
