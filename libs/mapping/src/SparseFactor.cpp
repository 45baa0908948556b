// SPDX-License-Identifier: BSD-3-Clause
#include "SparseFactor.h"

#include <utility>

namespace lintel {

namespace {

/// The matrix as CHOLMOD sees it: nothing is copied.
cholmod_sparse viewOf(Eigen::SparseMatrix<double>& lower) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(lower.rows());
  view.ncol = static_cast<std::size_t>(lower.cols());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = lower.outerIndexPtr();
  view.i = lower.innerIndexPtr();
  view.x = lower.valuePtr();
  view.stype = -1;  // only the lower triangle is read
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense viewOf(Eigen::MatrixXd& dense) {
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(dense.rows());
  view.ncol = static_cast<std::size_t>(dense.cols());
  view.nzmax = static_cast<std::size_t>(dense.size());
  view.d = view.nrow;
  view.x = dense.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

}  // namespace

SparseFactor::SparseFactor(Eigen::SparseMatrix<double> lower) {
  cholmod_start(&common_);
  common_.print = 0;
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.quick_return_if_not_posdef = 1;
  common_.nmethods = 1;  // one ordering, not the best of several
  common_.method[0].ordering = CHOLMOD_AMD;
  cholmod_sparse S = viewOf(lower);
  factor_ = cholmod_analyze(&S, &common_);
  usable_ = factor_ && cholmod_factorize(&S, factor_, &common_) && common_.status == CHOLMOD_OK;
}

SparseFactor::~SparseFactor() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_finish(&common_);
}

Eigen::MatrixXd SparseFactor::solveTransposed(Eigen::MatrixXd z) const {
  for (const int system : {CHOLMOD_Lt, CHOLMOD_Pt}) {
    cholmod_dense right = viewOf(z);
    cholmod_dense* x = cholmod_solve(system, factor_, &right, &common_);
    if (!x) return {};
    Eigen::MatrixXd solved = Eigen::MatrixXd::Map(static_cast<const double*>(x->x), z.rows(), z.cols());
    cholmod_free_dense(&x, &common_);
    z = std::move(solved);
  }
  return z;
}

}  // namespace lintel
