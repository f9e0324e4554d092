// Residuals of the refinement: the distance of a point of the current map to the line through its partner in
// the reference map, weighted. One parameter block (x, y, yaw) in metres and radians: where the current map's
// pivot lies in the reference map, and the yaw about it (a pivot among the points keeps shift and turn
// apart).
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

namespace cornerstone {

struct LinePair {
  Eigen::Vector2d current_m;  // relative to the pivot
  Eigen::Vector2d reference_m;
  Eigen::Vector2d normal;  // unit, of the line, in the reference map
  double weight = 1;       // factor of the residual
};

class LineCost : public ceres::CostFunction {
 public:
  explicit LineCost(const std::vector<LinePair>& pairs) : pairs_(pairs) {  // must outlive the cost
    set_num_residuals(static_cast<int>(pairs.size()));
    mutable_parameter_block_sizes()->push_back(3);
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const std::vector<LinePair>& pairs_;
};

}  // namespace cornerstone
