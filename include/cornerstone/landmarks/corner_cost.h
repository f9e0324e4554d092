// Residuals of the corner fit (paper, section 3.3): the distance of each model point to the nearest edge, and
// the stabiliser W (x - x_prev). One parameter block x = (X, Y, yaw) in cells and degrees, the units in which
// the paper scales W = 0.1 I; residuals in cells.
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "cornerstone/landmarks/distance_field.h"

namespace cornerstone {

class CornerCost : public ceres::CostFunction {
 public:
  // The field must outlive the cost. arm_cells: length of each segment; points_per_arm >= 2, ends included.
  CornerCost(const DistanceField& field, double arm_cells, int points_per_arm, double stabiliser);

  void setPrevious(const Eigen::Vector3d& x) { previous_ = x; }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const DistanceField& field_;
  double stabiliser_;
  Eigen::Vector3d previous_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector2d> model_cells_;  // in the corner's frame
};

}  // namespace cornerstone
