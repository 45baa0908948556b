// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/SmallLeastSquares.h"

#include <algorithm>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

void NormalEquations4::add(const Eigen::Matrix<double, 2, 4>& J, const Eigen::Vector2d& r, double w) {
  H += w * J.transpose() * J;
  b += w * J.transpose() * r;
}

Eigen::Vector4d dampedStep(const NormalEquations4& normal, double damping, const LevenbergParams& params) {
  Eigen::Matrix4d H = normal.H;
  H.diagonal() *= 1 + damping;
  H.diagonal().array() += params.absolute_damping + params.trace_damping * H.trace();
  return -solveLdlt(H, normal.b);
}

Eigen::Matrix4d covarianceOf(const Eigen::Matrix4d& information) {
  constexpr double kLeast = 1e-6;
  // the squared norm is the sum of 1 / eigenvalue: below the limit, none is raised
  if (const auto root = inverseRootLlt<4>(information); root && root->squaredNorm() < 1 / kLeast)
    return *root * root->transpose();
  const SymmetricEigen<4> eigen = symmetricEigen(information);
  const Eigen::Vector4d variance = eigen.values.cwiseMax(kLeast).cwiseInverse();
  return eigen.vectors * variance.asDiagonal() * eigen.vectors.transpose();
}

double worstSigma(const Eigen::Matrix2d& covariance) {
  return std::sqrt(std::max(symmetricEigen(covariance).values[1], 0.0));
}

}  // namespace lintel
