// SPDX-License-Identifier: BSD-3-Clause
#include "ReducedSystem.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <random>

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

void ReducedSystem::add(const ceres::CRSMatrix& jacobian, const std::vector<double>& weights) {
  std::vector<std::vector<int>> rows_of(static_cast<std::size_t>(landmarks_));
  for (int row = 0; row < jacobian.num_rows; ++row) {
    int landmark = landmarks_;
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i)
      landmark = std::min(landmark, jacobian.cols[i] / kLandmark);
    if (landmark < landmarks_)
      rows_of[static_cast<std::size_t>(landmark)].push_back(row);
    else
      addRows(jacobian, weights, {row}, landmarks_);
  }
  for (int i = 0; i < landmarks_; ++i) addRows(jacobian, weights, rows_of[static_cast<std::size_t>(i)], i);
}

void ReducedSystem::addRows(const ceres::CRSMatrix& jacobian, const std::vector<double>& weights,
                            const std::vector<int>& rows, int landmark) {
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
    const double weight = std::sqrt(weights[static_cast<std::size_t>(row)]);
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
      const int column = jacobian.cols[i];
      const double value = weight * jacobian.values[static_cast<std::size_t>(i)];
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
    const Eigen::LLT<Eigen::Matrix4d> root(H + 1e-9 * H.trace() * Eigen::Matrix4d::Identity());
    if (root.info() != Eigen::Success) return;
    const Eigen::MatrixXd U = root.matrixL().solve(W);
    G -= U.transpose() * U;
  }
  scatter(columns, G);
}

Eigen::MatrixXd& ReducedSystem::tile(int a, int b) {
  Eigen::MatrixXd& t = tiles_[{a, b}];
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

Eigen::MatrixXd ReducedSystem::draw(int count) const {
  const int n = begins_.back();
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [place, t] : tiles_)
    for (Eigen::Index c = 0; c < t.cols(); ++c)
      for (Eigen::Index r = 0; r < t.rows(); ++r) {
        const int row = begins_[static_cast<std::size_t>(place.first)] + static_cast<int>(r);
        const int column = begins_[static_cast<std::size_t>(place.second)] + static_cast<int>(c);
        if (row >= column && t(r, c) != 0) entries.emplace_back(row, column, t(r, c));
      }
  Eigen::SparseMatrix<double> S(n, n);
  S.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> root(S);
  if (root.info() != Eigen::Success) return {};
  Normal normal;
  Eigen::MatrixXd z(n, count);
  for (Eigen::Index c = 0; c < count; ++c)
    for (Eigen::Index r = 0; r < n; ++r) z(r, c) = normal();
  Eigen::MatrixXd x = root.permutationPinv() * root.matrixU().solve(z);
  if (!x.allFinite()) return {};
  return x;
}

}  // namespace lintel
