// SPDX-License-Identifier: BSD-3-Clause
#include "solver/InformationRoot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lintel {
namespace {

Eigen::MatrixXd randomMatrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
  Eigen::MatrixXd m(rows, columns);
  for (double& value : m.reshaped())
    value = 2 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1;
  return m;
}

/// J' J and J' r of residuals over states whose sizes differ as those of biases, metres and seconds do.
struct Problem {
  Eigen::MatrixXd J;
  Eigen::VectorXd r;

  Problem(Eigen::Index states, Eigen::Index rank, std::mt19937& random) : r(randomMatrix(3 * rank, 1, random)) {
    J = randomMatrix(3 * rank, rank, random) * randomMatrix(rank, states, random);
    for (Eigen::Index i = 0; i < states; ++i) J.col(i) *= std::pow(10.0, static_cast<double>(i % 7) - 2);
  }
  Eigen::MatrixXd H() const { return J.transpose() * J; }
  Eigen::VectorXd b() const { return J.transpose() * r; }
};

/// Largest error of each entry, relative to the diagonal.
double scaledError(const Eigen::MatrixXd& H, const Eigen::MatrixXd& other) {
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (H - other) * scale.asDiagonal()).cwiseAbs().maxCoeff();
}

TEST(InformationRoot, ItsSquareIsTheInformation) {
  std::mt19937 random(1);
  const Problem problem(30, 30, random);
  const LinearResidual root = informationRoot(problem.H(), problem.b());
  ASSERT_EQ(root.A.rows(), 30);
  EXPECT_LT(scaledError(problem.H(), root.A.transpose() * root.A), 1e-12);
  EXPECT_LT((root.A.transpose() * root.r_0 - problem.b()).cwiseQuotient(problem.H().diagonal().cwiseSqrt()).norm(),
            1e-9);
}

TEST(InformationRoot, DirectionsWithoutInformationGetNoRow) {
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {
    const Problem problem(40, 36, random);
    const LinearResidual root = informationRoot(problem.H(), problem.b());
    ASSERT_EQ(root.A.rows(), 36);
    EXPECT_LT(scaledError(problem.H(), root.A.transpose() * root.A), 1e-9);
    EXPECT_LT(root.r_0.norm(), problem.r.norm() * (1 + 1e-6)) << "a part of b that no residual explains";
  }
}

TEST(InformationRoot, RoundingInAStateThatOthersTellIsNoInformation) {
  // x0 and x1 are known only as a sum; rounding says more, and would make a residual of 950 sigmas of it
  Eigen::Matrix3d H;
  H << 1e6, 1e6, 0, 1e6, 1e6 * (1 + 1e-11), 0, 0, 0, 1;
  const LinearResidual root = informationRoot(H, Eigen::Vector3d(2, 5, 1));
  ASSERT_EQ(root.A.rows(), 2);
  EXPECT_NEAR(root.r_0.norm(), std::sqrt(4e-6 + 1), 1e-9);
}

TEST(InformationRoot, AStateOfWhichNothingIsKnownStaysOut) {
  const LinearResidual root = informationRoot(Eigen::Vector2d(0, 4).asDiagonal(), Eigen::Vector2d(0, 2));
  ASSERT_EQ(root.A.rows(), 1);
  EXPECT_EQ(root.A(0, 0), 0);
  EXPECT_EQ(root.A(0, 1), 2);
  EXPECT_EQ(root.r_0[0], 1);
}

}  // namespace
}  // namespace lintel
