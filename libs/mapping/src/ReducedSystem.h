// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/crs_matrix.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <map>
#include <utility>
#include <vector>

namespace lintel {

/// The information that residuals hold of some states when all landmarks are eliminated:
///   S = sum A^T A - A^T J (J^T J)^-1 J^T A
/// over the landmarks, with the residuals' Jacobians A by the states and J by the landmark.
///
/// The Jacobian's columns are those of the landmarks, four each, and then those of the states in tiles. S is kept by
/// tiles: few of them meet in a long recording.
class ReducedSystem {
 public:
  /// `tiles`: columns of each tile, in their order.
  ReducedSystem(std::size_t landmarks, const std::vector<int>& tiles);

  /// Adds residuals, each row with the given weight. All that a landmark has must come in one call.
  void add(const ceres::CRSMatrix& jacobian, double weight);

  /// Draws of the states' errors, N(0, S^-1), one a column; the same every time. Empty when S is singular.
  Eigen::MatrixXd draw(int count) const;

 private:
  void addRows(const ceres::CRSMatrix& jacobian, double weight, const std::vector<int>& rows, int landmark);
  void scatter(const std::vector<int>& columns, const Eigen::MatrixXd& G);
  Eigen::MatrixXd& tile(int a, int b);
  Eigen::SparseMatrix<double> lowerTriangle() const;

  static constexpr int kLandmark = 4;  // columns

  int landmarks_;
  std::vector<int> begins_;                               // of the tiles; the last entry is the end
  std::vector<int> tile_of_;                              // by column of the states
  std::map<std::pair<int, int>, Eigen::MatrixXd> tiles_;  // by (b, a) with a >= b: rows of a, columns of b
};

}  // namespace lintel
