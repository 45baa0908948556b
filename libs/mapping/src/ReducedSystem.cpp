// SPDX-License-Identifier: BSD-3-Clause
#include "ReducedSystem.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "SparseFactor.h"

namespace lintel {

namespace {

/// Standard normal numbers, the same with any library.
class Normal {
 public:
  double operator()() {
    const double u = uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
  }

 private:
  double uniform() { return (static_cast<double>(source_() >> 11) + 0.5) * 0x1p-53; }
  std::mt19937_64 source_;
};

}  // namespace

ReducedSystem::ReducedSystem(std::size_t landmarks, const std::vector<int>& tiles)
    : landmarks_(static_cast<int>(landmarks)), begins_{0} {
  for (const int size : tiles) {
    tile_of_.insert(tile_of_.end(), static_cast<std::size_t>(size), static_cast<int>(begins_.size()) - 1);
    begins_.push_back(begins_.back() + size);
  }
}

void ReducedSystem::add(const ceres::CRSMatrix& jacobian, double weight) {
  std::map<int, std::vector<int>> rows_of;
  for (int row = 0; row < jacobian.num_rows; ++row) {
    int landmark = landmarks_;
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i)
      landmark = std::min(landmark, jacobian.cols[i] / kLandmark);
    if (landmark < landmarks_)
      rows_of[landmark].push_back(row);
    else
      addRows(jacobian, weight, {row}, landmarks_);
  }
  for (const auto& [landmark, rows] : rows_of) addRows(jacobian, weight, rows, landmark);
}

void ReducedSystem::addRows(const ceres::CRSMatrix& jacobian, double weight, const std::vector<int>& rows,
                            int landmark) {
  const int first = kLandmark * landmarks_;
  std::vector<int> columns;
  for (const int row : rows)
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i)
      if (jacobian.cols[i] >= first) columns.push_back(jacobian.cols[i] - first);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  if (columns.empty()) return;
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(columns.size()));
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, kLandmark);
  for (Eigen::Index r = 0; r < n; ++r) {
    const int row = rows[static_cast<std::size_t>(r)];
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
      const int column = jacobian.cols[i];
      const double value = jacobian.values[static_cast<std::size_t>(i)];
      if (column >= first)
        A(r, std::lower_bound(columns.begin(), columns.end(), column - first) - columns.begin()) = value;
      else
        J(r, column - kLandmark * landmark) = value;
    }
  }
  Eigen::MatrixXd G = A.transpose() * A;
  if (landmark < landmarks_) {
    const Eigen::MatrixXd W = J.transpose() * A;
    const Eigen::Matrix4d H = J.transpose() * J;
    const Eigen::LLT<Eigen::Matrix4d> factor(H + 1e-9 * H.trace() * Eigen::Matrix4d::Identity());
    if (factor.info() != Eigen::Success) return;
    const Eigen::MatrixXd U = factor.matrixL().solve(W);
    G -= U.transpose() * U;
  }
  scatter(columns, weight * G);
}

Eigen::MatrixXd& ReducedSystem::tile(int a, int b) {
  Eigen::MatrixXd& t = tiles_[{b, a}];
  const auto size = [this](int i) {
    return begins_[static_cast<std::size_t>(i) + 1] - begins_[static_cast<std::size_t>(i)];
  };
  if (t.size() == 0) t = Eigen::MatrixXd::Zero(size(a), size(b));
  return t;
}

void ReducedSystem::scatter(const std::vector<int>& columns, const Eigen::MatrixXd& G) {
  const std::size_t n = columns.size();
  const auto tileOf = [this](int column) { return tile_of_[static_cast<std::size_t>(column)]; };
  const auto placeIn = [this](int column, int tile) { return column - begins_[static_cast<std::size_t>(tile)]; };
  for (std::size_t i = 0; i < n;) {
    const int a = tileOf(columns[i]);
    std::size_t i_end = i;
    while (i_end < n && tileOf(columns[i_end]) == a) ++i_end;
    for (std::size_t j = 0; j < i_end;) {
      const int b = tileOf(columns[j]);
      Eigen::MatrixXd& t = tile(a, b);
      const std::size_t from = j;
      for (; j < n && tileOf(columns[j]) == b; ++j)
        for (std::size_t k = i; k < i_end; ++k)
          t(placeIn(columns[k], a), placeIn(columns[j], b)) +=
              G(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j));
      if (j == from) break;
    }
    i = i_end;
  }
}

/// Without the zeros of the tiles: poses meet in many of them, velocities and biases in few.
Eigen::SparseMatrix<double> ReducedSystem::lowerTriangle() const {
  const auto forEach = [this](const auto& visit) {  // of each column the rows ascend
    for (const auto& [place, t] : tiles_)
      for (Eigen::Index c = 0; c < t.cols(); ++c)
        for (Eigen::Index r = place.first == place.second ? c : 0; r < t.rows(); ++r)
          if (t(r, c) != 0)
            visit(begins_[static_cast<std::size_t>(place.second)] + r,
                  begins_[static_cast<std::size_t>(place.first)] + c, t(r, c));
  };
  Eigen::VectorXi entries = Eigen::VectorXi::Zero(begins_.back());
  forEach([&](Eigen::Index, Eigen::Index column, double) { ++entries(column); });
  Eigen::SparseMatrix<double> S(begins_.back(), begins_.back());
  S.reserve(entries);
  forEach([&](Eigen::Index row, Eigen::Index column, double value) { S.insert(row, column) = value; });
  S.makeCompressed();
  return S;
}

Eigen::MatrixXd ReducedSystem::draw(int count) const {
  const SparseFactor factor(lowerTriangle());
  if (!factor.usable()) return {};
  Normal normal;
  Eigen::MatrixXd z(begins_.back(), count);
  for (Eigen::Index c = 0; c < z.cols(); ++c)
    for (Eigen::Index r = 0; r < z.rows(); ++r) z(r, c) = normal();
  Eigen::MatrixXd x = factor.solveTransposed(z);
  if (!x.allFinite()) return {};
  return x;
}

}  // namespace lintel
