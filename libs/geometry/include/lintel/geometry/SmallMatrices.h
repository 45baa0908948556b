// SPDX-License-Identifier: BSD-3-Clause
/// Decompositions of small matrices: Eigen's, to the last bit. Eigen's templates take seconds of compile time for
/// each size in each file that uses them; here they are compiled once. Other sizes do not link.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace lintel {

/// Eigenvalues in ascending order; the unit eigenvectors are the columns, in the same order.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Of a symmetric matrix, whose lower half is read; as by Eigen::SelfAdjointEigenSolver.
/// N is 2, 3, 4 or Eigen::Dynamic.
template <int N>
SymmetricEigen<N> symmetricEigen(const Eigen::Matrix<double, N, N>& A);

/// x of A x = b for a symmetric positive semi-definite A, as by Eigen::LDLT. N is 3 or 4.
template <int N>
Eigen::Matrix<double, N, 1> solveLdlt(const Eigen::Matrix<double, N, N>& A, const Eigen::Matrix<double, N, 1>& b);

/// S with S S^T = A^-1: the inverse of U of A = U^T U, as by Eigen::LLT; nothing if A is not positive definite.
/// N is 3 or 4.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> inverseRootLlt(const Eigen::Matrix<double, N, N>& A);

/// A = U diag(values) V^T, values descending; as by Eigen::JacobiSVD.
struct SingularValues3 {
  Eigen::Matrix3d U, V;
  Eigen::Vector3d values;
};
SingularValues3 singularValues(const Eigen::Matrix3d& A);

}  // namespace lintel
