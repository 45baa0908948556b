// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

template <int N>
SymmetricEigen<N> symmetricEigen(const Eigen::Matrix<double, N, N>& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

/// Two rows are tridiagonal already; the general way takes eight seconds to compile.
template <>
SymmetricEigen<2> symmetricEigen(const Eigen::Matrix2d& A) {
  const double largest = std::max({std::abs(A(0, 0)), std::abs(A(1, 0)), std::abs(A(1, 1))});
  const double scale = largest == 0 ? 1 : largest;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  const Eigen::Matrix<double, 1, 1> below(A(1, 0) / scale);
  solver.computeFromTridiagonal(Eigen::Vector2d(A.diagonal() / scale), below);
  return {solver.eigenvalues() * scale, solver.eigenvectors()};
}

template SymmetricEigen<3> symmetricEigen(const Eigen::Matrix3d&);
template SymmetricEigen<4> symmetricEigen(const Eigen::Matrix4d&);

}  // namespace lintel
