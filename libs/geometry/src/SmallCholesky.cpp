// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

template <int N>
Eigen::Matrix<double, N, 1> solveLdlt(const Eigen::Matrix<double, N, N>& A, const Eigen::Matrix<double, N, 1>& b) {
  return A.ldlt().solve(b);
}

template <int N>
std::optional<Eigen::Matrix<double, N, N>> inverseRootLlt(const Eigen::Matrix<double, N, N>& A) {
  using Matrix = Eigen::Matrix<double, N, N>;
  const Eigen::LLT<Matrix> llt(A);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return Matrix(llt.matrixU().solve(Matrix::Identity()));
}

template Eigen::Vector3d solveLdlt(const Eigen::Matrix3d&, const Eigen::Vector3d&);
template Eigen::Vector4d solveLdlt(const Eigen::Matrix4d&, const Eigen::Vector4d&);
template std::optional<Eigen::Matrix3d> inverseRootLlt(const Eigen::Matrix3d&);
template std::optional<Eigen::Matrix4d> inverseRootLlt(const Eigen::Matrix4d&);

}  // namespace lintel
