// SPDX-License-Identifier: BSD-3-Clause
#include "solver/SparseCholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <random>

#include "lintel/factors/StateBlocks.h"

namespace lintel {
namespace {

/// Positive definite; rows and columns above `border` hang together only within `reach` of each other.
Eigen::MatrixXd system(Eigen::Index n, Eigen::Index border, Eigen::Index reach) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      if (j >= border || i - j < reach) H(i, j) = H(j, i) = normal(random);
  H.diagonal().array() += 1 + H.cwiseAbs().rowwise().sum().maxCoeff();
  return H;
}

void expectFactor(const Eigen::MatrixXd& H) {
  Eigen::MatrixXd L = H;
  L.triangularView<Eigen::StrictlyUpper>().setConstant(std::numeric_limits<double>::quiet_NaN());  // never read
  ASSERT_TRUE(factoriseSparse(L));
  const Eigen::MatrixXd expected = H.llt().matrixL();
  EXPECT_LT((Eigen::MatrixXd(L.triangularView<Eigen::Lower>()) - expected).norm(), 1e-12 * expected.norm());
}

TEST(SparseCholesky, EqualsTheDenseFactor) {
  for (const Eigen::Index n : {1, 8, 9, 10, 18, 40, 182}) {
    SCOPED_TRACE(n);
    expectFactor(system(n, 0, n));      // full
    expectFactor(system(n, n, 12));     // a band
    expectFactor(system(n, n / 2, 3));  // a band with a full corner
  }
}

TEST(SparseCholesky, ByHand) {
  Eigen::MatrixXd H(2, 2);
  H << 4, 0, 2, 10;
  ASSERT_TRUE(factoriseSparse(H));
  EXPECT_DOUBLE_EQ(H(0, 0), 2);
  EXPECT_DOUBLE_EQ(H(1, 0), 1);
  EXPECT_DOUBLE_EQ(H(1, 1), 3);
}

TEST(SparseCholesky, NothingIsAlreadyFactorised) {
  Eigen::MatrixXd none(0, 0);
  EXPECT_TRUE(factoriseSparse(none));
}

TEST(SparseCholesky, SaysWhenItIsNotPositiveDefinite) {
  for (const Eigen::Index bad : {0, 8, 9, 20, 29}) {
    Eigen::MatrixXd H = system(30, 18, 4);
    H(bad, bad) = -1;
    EXPECT_FALSE(factoriseSparse(H)) << bad;
  }
  Eigen::MatrixXd singular = Eigen::MatrixXd::Identity(30, 30);
  singular(29, 29) = 0;
  EXPECT_FALSE(factoriseSparse(singular));
}

}  // namespace
}  // namespace lintel
