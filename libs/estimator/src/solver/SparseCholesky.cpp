// SPDX-License-Identifier: BSD-3-Clause
#include "solver/SparseCholesky.h"

#include <Eigen/Cholesky>
#include <vector>

#include "lintel/factors/StateBlocks.h"
#include "solver/PanelSquare.h"

namespace lintel {

namespace {

constexpr int kWidth = kMotionSize;
using Panel = Eigen::Matrix<double, Eigen::Dynamic, kWidth>;
using Block = Eigen::Matrix<double, kWidth, kWidth>;

/// The rows below a block that have entries in it, as rows of a panel.
std::vector<RowRun> rowsBelow(const Eigen::MatrixXd& H, Eigen::Index at) {
  std::vector<RowRun> runs;
  Eigen::Index from = 0;
  for (Eigen::Index r = at + kWidth; r < H.rows(); ++r)
    if ((H.block<1, kWidth>(r, at).array() != 0).any()) append({from++, r, 1}, runs);
  return runs;
}

/// P L^-T, column by column.
void divide(Panel& P, const Block& L) {
  for (int c = 0; c < kWidth; ++c) {
    for (int d = 0; d < c; ++d) P.col(c) -= L(c, d) * P.col(d);
    P.col(c) /= L(c, c);
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
    const std::vector<RowRun> runs = rowsBelow(H, at);
    if (runs.empty()) continue;
    Panel P(runs.back().from + runs.back().size, kWidth);
    for (const RowRun& run : runs) P.middleRows(run.from, run.size) = H.block(run.to, at, run.size, kWidth);
    divide(P, H.block<kWidth, kWidth>(at, at));
    for (const RowRun& run : runs) H.block(run.to, at, run.size, kWidth) = P.middleRows(run.from, run.size);
    subtractSquare<kWidth>(P, runs, H);
  }
  return at == H.rows() || factoriseBlock(H.bottomRightCorner(H.rows() - at, H.rows() - at));
}

}  // namespace lintel
