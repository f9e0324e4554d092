// What one cell of the grid remembers, and how it is read.
//
// A cell holds l, the log of how much likelier all looks so far are if it is occupied than if it is not; 0:
// never seen. With p0, the share of cells on a line of sight that hold a surface, the probability that it is
// occupied is
//   P = sigmoid(l + logit p0).
// Most cells are not surfaces, so P starts at p0, not at 1/2: a far look that spreads one surface over twenty
// cells leaves P = 1/20 in each, and only looks that agree make one of them a wall. Maps are published with
// the prior at 1/2:
//   published = P / (2 p0) for P < p0,  1/2 + (P - p0) / (2 (1 - p0)) above.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <array>

namespace cornerstone {

using EvidenceCell = mrpt::maps::COccupancyGridMap2D::cellType;  // MRPT: log-odds of *free*, steps of 1/16

class EvidenceScale {
 public:
  explicit EvidenceScale(double prior_occupied);
  static double logOddsOf(EvidenceCell cell) { return -cell / kStepsPerUnit; }
  static EvidenceCell cellOf(double log_odds);  // nearest step, held within what a cell can hold
  double occupied(EvidenceCell cell) const { return occupied_[index(cell)]; }  // P
  double hazard(EvidenceCell cell) const { return hazard_[index(cell)]; }  // of half a cell: 1 - sqrt(1 - P)
  float published(EvidenceCell cell) const { return published_[index(cell)]; }  // kUnseen exactly for 0
  EvidenceCell fromPublished(float probability) const;                          // 0 only for kUnseen exactly
  double logOddsFor(double occupied) const;                                     // l of a probability P

 private:
  static constexpr double kStepsPerUnit = 16;  // mrpt::maps::CLogOddsGridMapLUT
  static constexpr int kLargest = 127;
  static std::size_t index(EvidenceCell cell) { return static_cast<std::size_t>(cell + kLargest); }
  double prior_log_odds_;
  std::array<double, 2 * kLargest + 1> occupied_;
  std::array<double, 2 * kLargest + 1> hazard_;
  std::array<float, 2 * kLargest + 1> published_;
};

}  // namespace cornerstone
