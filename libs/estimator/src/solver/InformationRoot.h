// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace lintel {

/// A and r_0 of a linear residual r_0 + A dx.
struct LinearResidual {
  Eigen::MatrixXd A;
  Eigen::VectorXd r_0;
};

/// The residual whose half square is 1/2 dx' H dx + b' dx but for a constant: A' A = H, A' r_0 = b, by a Cholesky
/// decomposition that takes the state with the largest share of its information left next. It ends where the shares
/// are what rounding leaves: a direction without information, as the gauge, gets no row, and no part of b.
/// Eigen's LDLT takes the states in the order of their information before any other was taken, and may divide by a
/// pivot of rounding errors before it has come to the others.
LinearResidual informationRoot(const Eigen::MatrixXd& H, const Eigen::VectorXd& b);

}  // namespace lintel
