// SPDX-License-Identifier: BSD-3-Clause
#include "solver/SparseCholesky.h"

#include <Eigen/Cholesky>
#include <vector>

#include "lintel/factors/StateBlocks.h"

namespace lintel {

namespace {

constexpr int kWidth = kMotionSize;
using Panel = Eigen::Matrix<double, Eigen::Dynamic, kWidth>;
using Block = Eigen::Matrix<double, kWidth, kWidth>;

/// The rows below a block that have entries in it, ascending.
std::vector<Eigen::Index> rowsBelow(const Eigen::MatrixXd& H, Eigen::Index at) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index r = at + kWidth; r < H.rows(); ++r)
    if ((H.block<1, kWidth>(r, at).array() != 0).any()) rows.push_back(r);
  return rows;
}

/// P L^-T, column by column.
void divide(Panel& P, const Block& L) {
  for (int c = 0; c < kWidth; ++c) {
    for (int d = 0; d < c; ++d) P.col(c) -= L(c, d) * P.col(d);
    P.col(c) /= L(c, c);
  }
}

/// Takes P P^T from the rows and columns of H that P stands for.
void subtractSquare(const Panel& P, const std::vector<Eigen::Index>& rows, Eigen::MatrixXd& H) {
  Eigen::VectorXd column(P.rows());
  for (Eigen::Index j = 0; j < P.rows(); ++j) {
    const Eigen::Index n = P.rows() - j;
    column.head(n) = P.bottomRows(n).lazyProduct(P.row(j).transpose());
    double* into = &H(0, rows[static_cast<std::size_t>(j)]);
    for (Eigen::Index i = 0; i < n; ++i) into[rows[static_cast<std::size_t>(i + j)]] -= column[i];
  }
}

bool factoriseBlock(Eigen::Ref<Eigen::MatrixXd> H) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(H);
  return llt.info() == Eigen::Success;
}

}  // namespace

bool factoriseSparse(Eigen::MatrixXd& H) {
  Eigen::Index at = 0;
  for (; at + kWidth <= H.rows(); at += kWidth) {
    if (!factoriseBlock(H.block(at, at, kWidth, kWidth))) return false;
    const std::vector<Eigen::Index> rows = rowsBelow(H, at);
    if (rows.empty()) continue;
    Panel P(static_cast<Eigen::Index>(rows.size()), kWidth);
    for (int c = 0; c < kWidth; ++c)
      for (std::size_t i = 0; i < rows.size(); ++i) P(static_cast<Eigen::Index>(i), c) = H(rows[i], at + c);
    divide(P, H.block<kWidth, kWidth>(at, at));
    for (int c = 0; c < kWidth; ++c)
      for (std::size_t i = 0; i < rows.size(); ++i) H(rows[i], at + c) = P(static_cast<Eigen::Index>(i), c);
    subtractSquare(P, rows, H);
  }
  return at == H.rows() || factoriseBlock(H.bottomRightCorner(H.rows() - at, H.rows() - at));
}

}  // namespace lintel
