// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SplineTrajectory.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lintel {

namespace {

constexpr int kDegree = 5;
constexpr double kPi = 3.141592653589793;
using Weights = std::array<double, kDegree + 1>;

/// Weights of the degree+1 control points of a segment at u in [0, 1): the recursion of Cox and de Boor for unit knots.
Weights basis(int degree, double u) {
  Weights w{1};
  for (int k = 1; k <= degree; ++k) {
    Weights next{};
    for (int j = 0; j <= k; ++j) {
      if (j > 0) next[j] += (u + k - j) / k * w[j - 1];
      if (j < k) next[j] += (j + 1 - u) / k * w[j];
    }
    w = next;
  }
  return w;
}

/// Weights of a spline's derivative of a given order from the basis of lower degree; per unit of u.
Weights derivativeBasis(int order, double u) {
  Weights w = basis(kDegree - order, u);
  for (int k = kDegree - order + 1; k <= kDegree; ++k) {
    for (int j = k; j >= 0; --j) w[j] = (j > 0 ? w[j - 1] : 0) - (j < k ? w[j] : 0);
  }
  return w;
}

struct Place {
  int segment = 0;
  double u = 0;
};

Place placeOf(double t_s, double spacing_s, int segments) {
  const int segment = std::clamp(static_cast<int>(std::floor(t_s / spacing_s)), 0, segments - 1);
  return {segment, t_s / spacing_s - segment};
}

/// Least squares with a penalty on third differences of the control points, whose weight puts half response at `hz`.
Eigen::MatrixXd fit(const std::vector<double>& times_s, const Eigen::MatrixXd& values, double spacing_s, int segments,
                    double hz) {
  const int n = segments + kDegree;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, values.cols());
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const Place place = placeOf(times_s[i], spacing_s, segments);
    const Weights w = basis(kDegree, place.u);
    for (int a = 0; a <= kDegree; ++a) {
      right.row(place.segment + a) += w[a] * values.row(static_cast<Eigen::Index>(i));
      for (int b = 0; b <= kDegree; ++b) entries.emplace_back(place.segment + a, place.segment + b, w[a] * w[b]);
    }
  }
  const double samples_per_knot = static_cast<double>(times_s.size()) / segments;
  const double lambda = samples_per_knot / std::pow(2 * std::sin(std::min(0.5 * kPi, kPi * hz * spacing_s)), 6);
  const std::array<double, 4> difference{-1, 3, -3, 1};
  for (int i = 0; i + 3 < n; ++i) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) entries.emplace_back(i + a, i + b, lambda * difference[a] * difference[b]);
    }
  }
  Eigen::SparseMatrix<double> normal(n, n);
  normal.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  if (solver.info() != Eigen::Success)
    throw std::invalid_argument("SplineTrajectory: the poses do not define a spline");
  return solver.solve(right);
}

void checkPoses(const StampedPoses& poses, const SplineFitParams& params) {
  if (poses.size() < 8 || poses.back().first - poses.front().first < 1'000'000'000) {
    throw std::invalid_argument("SplineTrajectory: needs at least 8 poses over at least 1 s");
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].first < poses[i - 1].first) throw std::invalid_argument("SplineTrajectory: times must ascend");
  }
  if (params.knot_spacing_s <= 0 || params.position_hz <= 0 || params.rotation_hz <= 0) {
    throw std::invalid_argument("SplineTrajectory: spacing and frequencies must be positive");
  }
}

}  // namespace

SplineTrajectory::SplineTrajectory(const StampedPoses& poses, const SplineFitParams& params)
    : spacing_s_(params.knot_spacing_s) {
  checkPoses(poses, params);
  duration_s_ = 1e-9 * static_cast<double>(poses.back().first - poses.front().first);
  const int segments = static_cast<int>(std::ceil(duration_s_ / spacing_s_));
  std::vector<double> times_s;
  Eigen::MatrixXd positions(poses.size(), 3), rotations(poses.size(), 4);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    times_s.push_back(1e-9 * static_cast<double>(poses[i].first - poses.front().first));
    positions.row(row) = poses[i].second.p;
    rotations.row(row) = poses[i].second.q.normalized().coeffs();
    if (i > 0 && rotations.row(row).dot(rotations.row(row - 1)) < 0) rotations.row(row) *= -1;  // q and -q are the same
  }
  controls_.resize(segments + kDegree, 7);
  controls_.leftCols<3>() = fit(times_s, positions, spacing_s_, segments, params.position_hz);
  controls_.rightCols<4>() = fit(times_s, rotations, spacing_s_, segments, params.rotation_hz);
}

KinematicState SplineTrajectory::at(double t_s) const {
  const int segments = static_cast<int>(controls_.rows()) - kDegree;
  const Place place = placeOf(std::clamp(t_s, 0.0, duration_s_), spacing_s_, segments);
  std::array<Eigen::Matrix<double, 7, 1>, 3> s;
  double scale = 1;
  for (int order = 0; order < 3; ++order, scale /= spacing_s_) {
    const Weights w = derivativeBasis(order, place.u);
    s[order].setZero();
    for (int j = 0; j <= kDegree; ++j) s[order] += scale * w[j] * controls_.row(place.segment + j).transpose();
  }
  KinematicState state;
  state.T_w_b.p = s[0].head<3>();
  state.v_w_b = s[1].head<3>();
  state.a_w_b = s[2].head<3>();
  // q = s/|s|: its derivative is the part of s' across q; omega_b = 2 q^* q'
  const double norm = s[0].tail<4>().norm();
  const Eigen::Vector4d q = s[0].tail<4>() / norm, dq = (s[1].tail<4>() - q * q.dot(s[1].tail<4>())) / norm;
  state.T_w_b.q.coeffs() = q;
  Eigen::Quaterniond rate;
  rate.coeffs() = dq;
  state.omega_b = 2 * (state.T_w_b.q.conjugate() * rate).vec();
  return state;
}

}  // namespace lintel
