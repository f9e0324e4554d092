#include "cornerstone/base/sqrt_information.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <stdexcept>

namespace cornerstone {
namespace {

TEST(SqrtInformation, WhitensANonDiagonalCovariance) {
  Eigen::Matrix3d covariance;
  covariance << 4, 1, 0.5, 1, 3, 0.2, 0.5, 0.2, 2;
  const Eigen::Matrix3d r = sqrtInformation(covariance);
  EXPECT_NEAR((r.transpose() * r - covariance.inverse()).cwiseAbs().maxCoeff(), 0, 1e-12);
  EXPECT_NEAR((r * covariance * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0, 1e-12);
}

TEST(SqrtInformation, RefusesWhatIsNoCovariance) {
  Eigen::Matrix3d negative = Eigen::Matrix3d::Identity();
  negative(1, 1) = -1;
  EXPECT_THROW(sqrtInformation(negative), std::invalid_argument);
  Eigen::Matrix3d lopsided = Eigen::Matrix3d::Identity();
  lopsided(0, 1) = 0.5;
  EXPECT_THROW(sqrtInformation(lopsided), std::invalid_argument);
}

}  // namespace
}  // namespace cornerstone
