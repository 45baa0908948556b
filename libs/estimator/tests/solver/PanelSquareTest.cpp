// SPDX-License-Identifier: BSD-3-Clause
#include "solver/PanelSquare.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace lintel {
namespace {

TEST(PanelSquare, RunsThatFollowEachOtherAreOne) {
  std::vector<RowRun> runs;
  append({0, 3, 6}, runs);
  append({6, 9, 6}, runs);
  append({12, 20, 2}, runs);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].size, 12);
  EXPECT_EQ(runs[1].to, 20);
}

template <int T>
void isTakenFromTheLowerTriangle() {
  const std::vector<RowRun> runs{{0, 1, 7}, {7, 11, 1}, {8, 15, 6}};
  const Eigen::Matrix<double, Eigen::Dynamic, T> P = Eigen::MatrixXd::Random(14, T);
  const Eigen::MatrixXd before = Eigen::MatrixXd::Random(22, 22);
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(22, T), H = before;
  for (const RowRun& run : runs) spread.middleRows(run.to, run.size) = P.middleRows(run.from, run.size);
  subtractSquare<T>(P, runs, H);
  const Eigen::MatrixXd expected = before - spread * spread.transpose();
  for (Eigen::Index r = 0; r < 22; ++r)
    for (Eigen::Index c = 0; c < 22; ++c) EXPECT_NEAR(H(r, c), r >= c ? expected(r, c) : before(r, c), 1e-14);
}

TEST(PanelSquare, IsTakenFromTheLowerTriangleOnly) {
  isTakenFromTheLowerTriangle<3>();
  isTakenFromTheLowerTriangle<4>();
  isTakenFromTheLowerTriangle<9>();
}

}  // namespace
}  // namespace lintel
