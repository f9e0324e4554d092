// Bayes' rule for one beam over the cells it crosses (sensor cause model; Agha-mohammadi et al. 2019, cf.
// Thrun 2003).
//
// With P_i the probability that cell i along the beam is occupied, the surface that was measured at z is
//   cell i with  c_i ~ P_i prod_{j<i} (1 - P_j) N(z; r_i, sigma),
// or none of them (mismatch) with probability o. Then P(i occupied | z) = (1 - o) (c_i + B_i P_i) + o P_i,
// where B_i = sum_{j<i} c_j: what lies behind the surface stays as it was, what lies before it is free.
#pragma once

#include <vector>

#include "cornerstone/mapping/occupancy_grid.h"

namespace cornerstone {

class BeamEvidence {
 public:
  // origin_m, heading: sensor and the beam's direction in the map frame.
  BeamEvidence(const Beam& beam, const CellWindow& window, const OccupancyGrid& grid);
  void trace(const Eigen::Vector2d& origin_m, double heading_rad);

  double end_m() const { return end_m_; }      // farther cells learn nothing
  double start_m() const { return start_m_; }  // nearer cells are free but for mismatches
  double clear_m() const { return beam_.clear_m; }
  double outlier() const { return outlier_; }
  const Eigen::Vector2d& end() const { return point_m_; }  // the surface as measured, in the map frame
  double sigma_m() const { return sigma_m_; }
  // Probability that the cell at this range with probability `occupied` is the surface measured.
  double causeOf(double range_m, double occupied) const;
  double behindOf(double range_m) const;  // B_i
  double posteriorOf(double range_m, double occupied) const;

 private:
  double density(double range_m) const;  // N(z; range, sigma) in 1/m; two-sided: the far side is wider

  Beam beam_;
  Eigen::Vector2d point_m_ = Eigen::Vector2d::Zero();
  const CellWindow& window_;
  const OccupancyGrid& grid_;
  double step_m_;
  double sigma_m_;  // with the cell's own extent
  double sigma_near_m_;
  double sigma_far_m_;
  double start_m_;
  double end_m_;
  double outlier_ = 0;
  double normaliser_ = 1;
  std::vector<float> transmission_;  // prod (1 - P_j) before each step
  std::vector<float> behind_;        // cumulative cause before each step
};

}  // namespace cornerstone
