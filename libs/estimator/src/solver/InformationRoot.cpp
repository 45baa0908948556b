// SPDX-License-Identifier: BSD-3-Clause
#include "solver/InformationRoot.h"

#include <cmath>
#include <utility>

namespace lintel {

namespace {

constexpr double kNoInformation = 1e-8;  // relative to a residual of one sigma
constexpr double kRounding = 1e-10;      // share of a state's information: its sigma would be 100,000 times as large

}  // namespace

LinearResidual informationRoot(const Eigen::MatrixXd& H, const Eigen::VectorXd& b) {
  const Eigen::Index n = H.rows();
  const Eigen::VectorXd root = H.diagonal().unaryExpr([](double h) { return h > kNoInformation ? std::sqrt(h) : 0; });
  const Eigen::VectorXd scale = root.unaryExpr([](double r) { return r > 0 ? 1 / r : 0; });
  // Of the scaled matrix, its states in the order in which they are taken: the most informative one left each time.
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(static_cast<int>(n), 0, static_cast<int>(n) - 1);
  Eigen::VectorXd left = scale.cwiseProduct(root);  // the diagonal, less what was taken
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd r_0(n);
  Eigen::Index rank = 0, pivot = 0;
  for (; rank < n && left.tail(n - rank).maxCoeff(&pivot) > kRounding; ++rank) {
    pivot += rank;
    std::swap(order[rank], order[pivot]);
    std::swap(left[rank], left[pivot]);
    L.row(rank).head(rank).swap(L.row(pivot).head(rank));
    const int state = order[rank];
    const double diagonal = std::sqrt(left[rank]);
    L(rank, rank) = diagonal;
    r_0[rank] = (scale[state] * b[state] - L.row(rank).head(rank).dot(r_0.head(rank))) / diagonal;
    const Eigen::Index below = n - rank - 1;
    auto column = L.col(rank).tail(below);
    for (Eigen::Index i = 0; i < below; ++i)
      column[i] = scale[state] * scale[order[rank + 1 + i]] * H(order[rank + 1 + i], state);
    column.noalias() -= L.bottomLeftCorner(below, rank) * L.row(rank).head(rank).transpose();
    column = (left.tail(below).array() == 0).select(0, column / diagonal);
    left.tail(below) = (left.tail(below) - column.cwiseAbs2()).cwiseMax(0);
  }
  LinearResidual result{Eigen::MatrixXd(rank, n), r_0.head(rank)};
  for (Eigen::Index i = 0; i < n; ++i) result.A.col(order[i]) = root[order[i]] * L.row(i).head(rank).transpose();
  return result;
}

}  // namespace lintel
