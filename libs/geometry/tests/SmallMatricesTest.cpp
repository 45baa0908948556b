// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/SmallMatrices.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

/// A positive definite matrix with eigenvalues far apart.
template <int N>
Eigen::Matrix<double, N, N> example(Eigen::Index size) {
  Eigen::Matrix<double, N, N> A(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < size; ++k)
      A(i, k) = 1.0 / static_cast<double>(i + k + 1) + (i == k ? static_cast<double>(i) : 0);
  return A;
}

template <int N>
void expectDecomposition(const Eigen::Matrix<double, N, N>& A) {
  const SymmetricEigen<N> eigen = symmetricEigen(A);
  EXPECT_LT((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), 1e-14 * A.norm());
  EXPECT_TRUE((eigen.vectors.transpose() * eigen.vectors).isIdentity(1e-14));
  for (Eigen::Index i = 1; i < A.rows(); ++i) EXPECT_LE(eigen.values[i - 1], eigen.values[i]);
}

TEST(SmallMatrices, EigenvectorsDiagonaliseInAscendingOrder) {
  expectDecomposition(example<2>(2));
  expectDecomposition(example<3>(3));
  expectDecomposition(example<4>(4));
  expectDecomposition(example<Eigen::Dynamic>(6));
}

TEST(SmallMatrices, TwoRowsOfAnySizeAndKind) {
  for (const double scale : {1e-100, 1.0, 1e100}) {
    expectDecomposition<2>(scale * (Eigen::Matrix2d() << 1, 2, 2, 1).finished());
    expectDecomposition<2>(scale * (Eigen::Matrix2d() << 3, 0, 0, -5).finished());
    expectDecomposition<2>(scale * (Eigen::Matrix2d() << 4, 2, 2, 1).finished());
  }
  EXPECT_EQ(symmetricEigen<2>(Eigen::Matrix2d::Zero()).values.norm(), 0);
}

TEST(SmallMatrices, SolvesForTheUnknowns) {
  const Eigen::Vector3d x3(1, -2, 3);
  const Eigen::Vector4d x4(1, -2, 3, -4);
  const Eigen::Vector3d b3 = example<3>(3) * x3;
  const Eigen::Vector4d b4 = example<4>(4) * x4;
  EXPECT_TRUE(solveLdlt(example<3>(3), b3).isApprox(x3, 1e-12));
  EXPECT_TRUE(solveLdlt(example<4>(4), b4).isApprox(x4, 1e-12));
}

TEST(SmallMatrices, RootOfTheInverse) {
  const Eigen::Matrix3d A3 = example<3>(3);
  const Eigen::Matrix4d A4 = example<4>(4);
  const Eigen::Matrix3d S3 = inverseRootLlt(A3).value();
  const Eigen::Matrix4d S4 = inverseRootLlt(A4).value();
  EXPECT_TRUE((A3 * S3 * S3.transpose()).isIdentity(1e-12));
  EXPECT_TRUE((A4 * S4 * S4.transpose()).isIdentity(1e-12));
  EXPECT_FALSE(inverseRootLlt<3>(-A3).has_value());
}

TEST(SmallMatrices, SingularValuesDescendAndGiveTheMatrixBack) {
  const Eigen::Matrix3d A = (Eigen::Matrix3d() << 1, 2, -3, 0, 4, 1, 2, 2, 2).finished();
  const SingularValues3 svd = singularValues(A);
  EXPECT_LT((svd.U * svd.values.asDiagonal() * svd.V.transpose() - A).norm(), 1e-14 * A.norm());
  EXPECT_TRUE((svd.U.transpose() * svd.U).isIdentity(1e-14));
  EXPECT_TRUE((svd.V.transpose() * svd.V).isIdentity(1e-14));
  EXPECT_GE(svd.values[0], svd.values[1]);
  EXPECT_GE(svd.values[1], svd.values[2]);
}

}  // namespace
}  // namespace lintel
