// SPDX-License-Identifier: BSD-3-Clause
// Apart from SmallEigen.cpp, so that two cores compile them.
#include <Eigen/Eigenvalues>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

template <>
SymmetricEigen<Eigen::Dynamic> symmetricEigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace lintel
