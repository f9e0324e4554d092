// The matrix that whitens a residual: for covariance C it returns R with R'R = C^-1, so that |R r|^2 is the
// squared Mahalanobis length of r. (Weighting with the Cholesky factor L of the information untransposed is a
// common fault: it is right for diagonal matrices only.)
#pragma once

#include <Eigen/Core>

namespace cornerstone {

// covariance: symmetric positive definite, order (x, y, yaw), m and rad; otherwise std::invalid_argument.
Eigen::Matrix3d sqrtInformation(const Eigen::Matrix3d& covariance);

}  // namespace cornerstone
