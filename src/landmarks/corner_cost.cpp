#include "cornerstone/landmarks/corner_cost.h"

#include <cmath>

namespace cornerstone {

CornerCost::CornerCost(const DistanceField& field, double arm_cells, int points_per_arm, double stabiliser)
    : field_(field), stabiliser_(stabiliser) {
  for (int i = 0; i < points_per_arm; ++i) model_cells_.emplace_back(arm_cells * i / (points_per_arm - 1), 0);
  for (int i = 1; i < points_per_arm; ++i) model_cells_.emplace_back(0, arm_cells * i / (points_per_arm - 1));
  set_num_residuals(static_cast<int>(model_cells_.size()) + 3);
  mutable_parameter_block_sizes()->push_back(3);
}

bool CornerCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const double* x = parameters[0];
  const double rad_per_deg = M_PI / 180, c = std::cos(x[2] * rad_per_deg), s = std::sin(x[2] * rad_per_deg);
  double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
  for (const Eigen::Vector2d& m : model_cells_) {
    const Eigen::Vector2d turned(c * m.x() - s * m.y(), s * m.x() + c * m.y());
    Eigen::Vector2d gradient;
    *residuals++ = field_.at(Eigen::Vector2d(x[0], x[1]) + turned, gradient);
    if (jacobian == nullptr) continue;
    *jacobian++ = gradient.x();
    *jacobian++ = gradient.y();
    *jacobian++ = rad_per_deg * (gradient.y() * turned.x() - gradient.x() * turned.y());
  }
  for (int i = 0; i < 3; ++i) {
    *residuals++ = stabiliser_ * (x[i] - previous_[i]);
    if (jacobian == nullptr) continue;
    for (int j = 0; j < 3; ++j) *jacobian++ = i == j ? stabiliser_ : 0;
  }
  return true;
}

}  // namespace cornerstone
