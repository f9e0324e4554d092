#include "cornerstone/mapping/evidence.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {
namespace {

double logit(double probability) { return std::log(probability / (1 - probability)); }
double sigmoid(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

}  // namespace

EvidenceScale::EvidenceScale(double prior_occupied) : prior_log_odds_(logit(prior_occupied)) {
  for (int value = -kLargest; value <= kLargest; ++value) {
    const auto cell = static_cast<EvidenceCell>(value);
    const double p = sigmoid(logOddsOf(cell) + prior_log_odds_);
    occupied_[index(cell)] = p;
    hazard_[index(cell)] = 1 - std::sqrt(1 - p);
    const double scaled = p < prior_occupied ? p / (2 * prior_occupied)
                                             : 0.5 + (p - prior_occupied) / (2 * (1 - prior_occupied));
    published_[index(cell)] = static_cast<float>(scaled);
  }
  published_[index(0)] = kUnseen;
}

EvidenceCell EvidenceScale::cellOf(double log_odds) {
  const double steps = std::clamp(-log_odds * kStepsPerUnit, -1.0 * kLargest, 1.0 * kLargest);
  return static_cast<EvidenceCell>(std::lround(steps));
}

EvidenceCell EvidenceScale::fromPublished(float probability) const {
  if (probability == kUnseen) return 0;
  // Published probabilities fall as the cell's value (evidence for free) rises.
  const auto first =
      std::lower_bound(published_.begin(), published_.end(), probability, std::greater<float>());
  auto best = first == published_.end() ? first - 1 : first;
  if (best != published_.begin() && std::abs(*(best - 1) - probability) < std::abs(*best - probability))
    --best;
  const auto value = static_cast<int>(best - published_.begin()) - kLargest;
  if (value == 0) return static_cast<EvidenceCell>(probability > kUnseen ? -1 : 1);
  return static_cast<EvidenceCell>(value);
}

double EvidenceScale::logOddsFor(double occupied) const { return logit(occupied) - prior_log_odds_; }

}  // namespace cornerstone
