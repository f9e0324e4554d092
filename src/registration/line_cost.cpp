#include "cornerstone/registration/line_cost.h"

#include <cmath>

namespace cornerstone {

bool LineCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Vector2d shift(parameters[0][0], parameters[0][1]);
  const double c = std::cos(parameters[0][2]), s = std::sin(parameters[0][2]);
  double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
  for (const LinePair& pair : pairs_) {
    const Eigen::Vector2d turned(c * pair.current_m.x() - s * pair.current_m.y(),
                                 s * pair.current_m.x() + c * pair.current_m.y());
    *residuals++ = pair.weight * pair.normal.dot(turned + shift - pair.reference_m);
    if (jacobian == nullptr) continue;
    *jacobian++ = pair.weight * pair.normal.x();
    *jacobian++ = pair.weight * pair.normal.y();
    *jacobian++ = pair.weight * (pair.normal.y() * turned.x() - pair.normal.x() * turned.y());
  }
  return true;
}

}  // namespace cornerstone
