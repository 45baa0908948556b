// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lintel {

/// Rows of a panel, `from` on, that lie side by side in a symmetric matrix, too, `to` on.
struct RowRun {
  Eigen::Index from, to, size;
};

/// Appends a run, to the last one where it follows it.
void append(const RowRun& run, std::vector<RowRun>& runs);

/// Takes P P^T from the lower triangle of H. The runs, ascending, say where the rows of P lie in it. T: 3, 4, 9.
template <int T>
void subtractSquare(const Eigen::Matrix<double, Eigen::Dynamic, T>& P, const std::vector<RowRun>& runs,
                    Eigen::MatrixXd& H);

}  // namespace lintel
