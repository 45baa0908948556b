// SPDX-License-Identifier: BSD-3-Clause
#include "../src/SparseFactor.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace lintel {
namespace {

constexpr Eigen::Index kSize = 60;

/// A chain of states whose first one meets all: orderings other than the given one have fewer entries.
Eigen::MatrixXd chain() {
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(kSize, kSize);
  for (Eigen::Index i = 0; i < kSize; ++i) {
    S(i, i) = 4 + std::sin(1.3 * static_cast<double>(i));
    if (i > 0) S(i, i - 1) = S(i - 1, i) = -1;
    if (i > 1) S(i, 0) = S(0, i) = 0.2;
  }
  return S;
}

Eigen::SparseMatrix<double> lowerOf(const Eigen::MatrixXd& S) {
  return Eigen::MatrixXd(S.triangularView<Eigen::Lower>()).sparseView();
}

TEST(SparseFactor, UnitVectorsMakeTheInverse) {
  const SparseFactor factor(lowerOf(chain()));
  ASSERT_TRUE(factor.usable());
  const Eigen::MatrixXd root = factor.solveTransposed(Eigen::MatrixXd::Identity(kSize, kSize));
  EXPECT_LT((root * root.transpose() - chain().inverse()).norm(), 1e-12);
}

TEST(SparseFactor, AMatrixThatIsNotPositiveDefiniteHasNone) {
  Eigen::MatrixXd S = chain();
  S(7, 7) = -1;
  EXPECT_FALSE(SparseFactor(lowerOf(S)).usable());
  S(7, 7) = 0, S.row(7).setZero(), S.col(7).setZero();
  EXPECT_FALSE(SparseFactor(lowerOf(S)).usable());
}

}  // namespace
}  // namespace lintel
