#include "cornerstone/base/sqrt_information.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <stdexcept>

namespace cornerstone {

Eigen::Matrix3d sqrtInformation(const Eigen::Matrix3d& covariance) {
  const bool symmetric =
      (covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * covariance.cwiseAbs().maxCoeff();
  const Eigen::LLT<Eigen::Matrix3d> covariance_llt(covariance);
  if (!covariance.allFinite() || !symmetric || covariance_llt.info() != Eigen::Success)
    throw std::invalid_argument("sqrtInformation: the covariance is not symmetric positive definite");
  // C = L L', so C^-1 = L^-T L^-1 and R = L^-1.
  return covariance_llt.matrixL().solve(Eigen::Matrix3d::Identity());
}

}  // namespace cornerstone
