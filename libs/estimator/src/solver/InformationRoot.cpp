// SPDX-License-Identifier: BSD-3-Clause
#include "solver/InformationRoot.h"

#include <cmath>

namespace lintel {

namespace {

constexpr double kNoInformation = 1e-8;  // relative to a residual of one sigma
constexpr double kRounding = 1e-10;      // share of a state's information: its sigma would be 100,000 times as large

}  // namespace

LinearResidual informationRoot(const Eigen::MatrixXd& H, const Eigen::VectorXd& b) {
  const Eigen::Index n = H.rows();
  const Eigen::VectorXd root = H.diagonal().unaryExpr([](double h) { return h > kNoInformation ? std::sqrt(h) : 0; });
  const Eigen::VectorXd scale = root.unaryExpr([](double r) { return r > 0 ? 1 / r : 0; });
  Eigen::VectorXd left = scale.cwiseProduct(root);  // the diagonal of the scaled matrix, less what was taken
  Eigen::MatrixXd L(n, n);                          // of the scaled matrix, rows in the order of the states
  Eigen::VectorXd r_0(n);
  Eigen::Index rank = 0, pivot = 0;
  for (; rank < n && left.maxCoeff(&pivot) > kRounding; ++rank) {
    auto column = L.col(rank);
    column = scale[pivot] * scale.cwiseProduct(H.col(pivot));
    column.noalias() -= L.leftCols(rank) * L.row(pivot).head(rank).transpose();
    const double diagonal = std::sqrt(left[pivot]);
    column = (left.array() == 0).select(0, column / diagonal);
    column[pivot] = diagonal;
    r_0[rank] = (scale[pivot] * b[pivot] - L.row(pivot).head(rank).dot(r_0.head(rank))) / diagonal;
    left = (left - column.cwiseAbs2()).cwiseMax(0);
    left[pivot] = 0;
  }
  return {(root.asDiagonal() * L.leftCols(rank)).transpose(), r_0.head(rank)};
}

}  // namespace lintel
