// SPDX-License-Identifier: BSD-3-Clause
#include "../src/ReducedSystem.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace lintel {
namespace {

/// A Jacobian of two landmarks and two tiles of states, with rows of every kind.
ceres::CRSMatrix crsOf(const Eigen::MatrixXd& J) {
  ceres::CRSMatrix crs;
  crs.num_rows = static_cast<int>(J.rows()), crs.num_cols = static_cast<int>(J.cols());
  crs.rows.push_back(0);
  for (Eigen::Index r = 0; r < J.rows(); ++r) {
    for (Eigen::Index c = 0; c < J.cols(); ++c)
      if (J(r, c) != 0) crs.cols.push_back(static_cast<int>(c)), crs.values.push_back(J(r, c));
    crs.rows.push_back(static_cast<int>(crs.cols.size()));
  }
  return crs;
}

Eigen::MatrixXd jacobian() {
  constexpr int kRows = 30;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(kRows, 8 + 5);
  for (int r = 0; r < kRows; ++r) {
    const int landmark = r % 3;  // 2: none
    for (int c = 0; c < 4 && landmark < 2; ++c) J(r, 4 * landmark + c) = std::sin(3.1 * r + 1.7 * c + 1);
    for (int c = 0; c < 5; ++c)
      if ((r + c) % 4 != 0) J(r, 8 + c) = std::cos(2.3 * r * (c + 1) + 0.4);
  }
  return J;
}

TEST(ReducedSystem, ErrorsAreDrawnAsTheWholeSystemSays) {
  const Eigen::MatrixXd J = jacobian();
  Eigen::VectorXd w(J.rows());
  for (int r = 0; r < J.rows(); ++r) w(r) = r % 3 == 0 ? 0.5 : 2;
  const Eigen::MatrixXd whole = (J.transpose() * w.asDiagonal() * J).inverse();
  const Eigen::MatrixXd expected = whole.bottomRightCorner(5, 5);

  // the rows of a landmark together, as they have the same weight
  ReducedSystem system(2, {2, 3});
  for (int landmark = 0; landmark < 3; ++landmark) {
    Eigen::MatrixXd rows = J;
    for (int r = 0; r < J.rows(); ++r)
      if (r % 3 != landmark) rows.row(r).setZero();
    system.add(crsOf(rows), landmark == 0 ? 0.5 : 2);
  }
  constexpr int kMany = 20000;
  const Eigen::MatrixXd drawn = system.draw(kMany);
  ASSERT_EQ(drawn.rows(), 5);
  const Eigen::MatrixXd covariance = drawn * drawn.transpose() / kMany;
  EXPECT_LT((covariance - expected).norm(), 0.05 * expected.norm());
  EXPECT_EQ(system.draw(3), system.draw(3));
}

TEST(ReducedSystem, WhatIsNotDeterminedGivesNone) {
  Eigen::MatrixXd J = jacobian();
  J.col(10).setZero();
  ReducedSystem system(2, {2, 3});
  system.add(crsOf(J), 1);
  EXPECT_EQ(system.draw(3).size(), 0);
}

}  // namespace
}  // namespace lintel
