// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace lintel {

/// Cholesky factor of a positive definite matrix, in place, lower triangle in and out (above it nothing is read or
/// written): H = L L^T [Golub2013]. Columns go in blocks as wide as a state's motion; what a block does not touch is
/// skipped, so zeros cost nothing as long as the columns with few entries come first. False when H is not positive
/// definite.
bool factoriseSparse(Eigen::MatrixXd& H);

}  // namespace lintel
