// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/SVD>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

SingularValues3 singularValues(const Eigen::Matrix3d& A) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

}  // namespace lintel
