// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The members of LandmarkBlock, for the files that instantiate them: one kind a file, each takes its time to compile.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lintel/geometry/SmallMatrices.h"
#include "solver/LandmarkBlock.h"

namespace lintel {

namespace landmark_block {

constexpr double kNoInformation = 1e-8;  // eigenvalues below count as zero; residuals are in standard deviations
constexpr double kLeastDamping = 1e-6;   // times the damping: the least that is added to a diagonal

template <int Rows, int Columns>
using ByRows = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;

/// d residual / d tangent of the landmark; `plus`: the Jacobian of its manifold's Plus.
template <class Target, class PlusJacobian>
Eigen::Matrix<double, Target::kRows, Target::kTangent> tangentJacobian(const ImageLinearisation<Target>& l,
                                                                       const PlusJacobian& plus) {
  if constexpr (Target::kColumns == Target::kTangent)
    return l.d_target;
  else
    return l.d_target * plus;
}

/// S with S S^T = H^-1; a pseudo-inverse where H has no information.
template <int T>
Eigen::Matrix<double, T, T> inverseRoot(Eigen::Matrix<double, T, T> H, double damping) {
  for (int i = 0; i < T; ++i) H(i, i) += damping * std::max(H(i, i), kLeastDamping);
  // the squared norm is the sum of 1 / eigenvalue: below the limit, no eigenvalue counts as zero
  if (const auto root = inverseRootLlt<T>(H); root && (damping > 0 || root->squaredNorm() < 1 / kNoInformation))
    return *root;
  const SymmetricEigen<T> eigen = symmetricEigen<T>(H);
  const auto root = eigen.values.unaryExpr([](double v) { return v > kNoInformation ? 1 / std::sqrt(v) : 0.0; });
  return eigen.vectors * root.asDiagonal();
}

}  // namespace landmark_block

/// The kind of noise that makes the residuals likeliest. The determinant is that of all residuals; the landmark takes
/// its degrees of freedom off, and with them its share of the determinant: otherwise short tracks, whose residuals the
/// landmark takes up, were all of the quietest kind.
template <class Target>
void LandmarkBlock<Target>::chooseNoise(const Residuals& residuals) {
  std::vector<double> t_s;
  for (const Sighting& s : sightings) t_s.push_back(s.t_s);
  const auto count = static_cast<int>(residuals.size());
  const double determinants = static_cast<double>(R) * std::max(1, count - T) / count;
  const NoiseKind* likeliest = &noise->kinds.front();
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd weights;
  for (const NoiseKind& kind : noise->kinds) {
    if (noise->kinds.size() == 1) break;
    Residuals whitened = residuals;
    const double log_det = whiten(kind, t_s, whitened);
    const double cost = whitenedCost(whitened, weights) + determinants * log_det;
    if (cost < least) {
      least = cost;
      likeliest = &kind;
    }
  }
  whitening = whitener(*likeliest, t_s);
}

template <class Target>
double LandmarkBlock<Target>::trackCost(const Residuals& residuals, Eigen::VectorXd& weights) const {
  return whitenedCost(whitening.template triangularView<Eigen::Lower>() * residuals, weights);
}

/// The weights are the derivatives of the cost by half the squares of whitened residuals.
template <class Target>
double LandmarkBlock<Target>::whitenedCost(const Residuals& whitened, Eigen::VectorXd& weights) const {
  weights.resize(whitened.rows());
  double sum = 0, track_weight;
  for (Eigen::Index i = 0; i < whitened.rows(); ++i) sum += robustCost(loss, whitened.row(i).squaredNorm(), weights[i]);
  sum = TrackLoss(noise->freedom).cost(2 * sum, static_cast<int>(whitened.size()), T, track_weight);
  weights *= track_weight;
  return sum;
}

template <class Target>
double LandmarkBlock<Target>::cost(const std::vector<CameraView>& views, const double* correction,
                                   const CameraLayout& layout) const {
  Residuals residuals(sightings.size(), +R);
  ImageLinearisation<Target> l;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& s = sightings[i];
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, block, false, l);
    residuals.row(static_cast<Eigen::Index>(i)) = l.residual;
  }
  Eigen::VectorXd weights;
  double sum = trackCost(residuals, weights);
  if (tie) {
    const double* blocks[] = {block, layout.block(direction)};
    Eigen::Vector3d r;
    double weight;
    tie->cost->Evaluate(blocks, r.data(), nullptr);
    sum += robustCost(tie->loss, r.squaredNorm(), weight);
  }
  return sum;
}

template <class Target>
void LandmarkBlock<Target>::prepare(const CameraLayout& layout) {
  Eigen::Index count = 0;
  const auto place = [&](Eigen::Index to, Eigen::Index size) {
    append({count, to, size}, runs);
    count += size;
  };
  for (const Sighting& s : sightings) {
    camera_places.push_back(layout.camera(s.camera));
    place(camera_places.back(), kCameraTangent);
  }
  place(layout.correction(), kSightingCorrection);
  if (tie) place(layout.target(direction), kDirectionTangent);
  W.resize(count, T);
}

template <class Target>
double LandmarkBlock<Target>::linearise(const std::vector<CameraView>& views, const double* correction,
                                        const CameraLayout& layout, CameraEquations& eq) {
  H.setZero();
  b.setZero();
  W.template middleRows<kSightingCorrection>(correctionRow()).setZero();
  PlusJacobian plus;
  manifoldOf(kKindOf<Target>)->PlusJacobian(block, plus.data());
  const std::size_t n = sightings.size();
  Residuals residuals(n, +R);
  rows.resize(n);
  camera_rows.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    ImageLinearisation<Target>& l = sightings[i].linearised;
    sightings[i].factor->linearise(views[static_cast<std::size_t>(sightings[i].camera)], correction, block, true, l);
    rows[i] << landmark_block::tangentJacobian(l, plus), l.d_correction, l.residual;
    camera_rows[i] = l.d_camera;
    residuals.row(static_cast<Eigen::Index>(i)) = l.residual;
  }
  if (whitening.size() == 0) chooseNoise(residuals);
  Eigen::VectorXd weights;
  double sum = trackCost(residuals, weights);
  weighSightings(weights);
  for (std::size_t i = 0; i < n; ++i) addSighting(i, layout, eq);
  addCameraPairs(camera_rows, information, camera_places, eq.H);
  if (tie) sum += addTie(layout, eq);
  return sum;
}

/// `information`, and the sightings' rows times it.
template <class Target>
void LandmarkBlock<Target>::weighSightings(const Eigen::VectorXd& weights) {
  const Eigen::Index n = weights.size();
  information.setZero(n, n);
  for (Eigen::Index k = 0; k < n; ++k)  // row k of L^-1 ends with column k
    for (Eigen::Index j = 0; j <= k; ++j)
      if (const double w = weights[k] * whitening(k, j); w != 0)
        information.col(j).head(k + 1) += w * whitening.row(k).head(k + 1).transpose();
  weighted_rows.resize(rows.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    SightingRows& sum = weighted_rows[static_cast<std::size_t>(i)];
    sum.setZero();
    for (Eigen::Index j = 0; j < n; ++j)
      if (information(i, j) != 0) sum += information(i, j) * rows[static_cast<std::size_t>(j)];
  }
}

template <class Target>
void LandmarkBlock<Target>::addSighting(std::size_t i, const CameraLayout& layout, CameraEquations& eq) {
  using landmark_block::ByRows;  // their transposed ones lie by columns, which makes products of them fast
  const ByRows<R, T> J = rows[i].template leftCols<T>(), weighted_J = weighted_rows[i].template leftCols<T>();
  const ByRows<R, kSightingCorrection> Ji = rows[i].template middleCols<kSightingCorrection>(T),
                                       weighted_Ji = weighted_rows[i].template middleCols<kSightingCorrection>(T);
  const Eigen::Matrix<double, R, 1> weighted_r = weighted_rows[i].template rightCols<1>();
  const CameraRows& Jc = camera_rows[i];
  H.noalias() += J.transpose() * weighted_J;
  b.noalias() += J.transpose() * weighted_r;
  W.template middleRows<kSightingCorrection>(correctionRow()).noalias() += Ji.transpose() * weighted_J;
  W.template middleRows<kCameraTangent>(kCameraTangent * static_cast<Eigen::Index>(i)).noalias() =
      Jc.transpose() * weighted_J;
  const Eigen::Index at = layout.camera(sightings[i].camera), correction = layout.correction();
  eq.H.block<kSightingCorrection, kCameraTangent>(correction, at).noalias() += weighted_Ji.transpose() * Jc;
  eq.H.block<kSightingCorrection, kSightingCorrection>(correction, correction).noalias() +=
      Ji.transpose() * weighted_Ji;
  eq.b.segment<kCameraTangent>(at).noalias() += Jc.transpose() * weighted_r;
  eq.b.segment<kSightingCorrection>(correction).noalias() += Ji.transpose() * weighted_r;
}

template <class Target>
void LandmarkBlock<Target>::eliminate(double damping, CameraEquations& eq) {
  inverse_root = landmark_block::inverseRoot<T>(H, damping);
  const Eigen::Matrix<double, T, 1> y = inverse_root.transpose() * b;
  Y = W.lazyProduct(inverse_root);
  subtractSquare<T>(Y, runs, eq.H);
  for (const RowRun& run : runs)
    eq.b.segment(run.to, run.size).noalias() -= Y.middleRows(run.from, run.size).lazyProduct(y);
}

template <class Target>
double LandmarkBlock<Target>::backSubstitute(const Eigen::VectorXd& camera_step, double damping) {
  Eigen::Matrix<double, T, 1> y = inverse_root.transpose() * b;
  for (const RowRun& run : runs)
    y += Y.middleRows(run.from, run.size).transpose().lazyProduct(camera_step.segment(run.to, run.size));
  step = -inverse_root * y;
  const auto damped = damping * H.diagonal().cwiseMax(landmark_block::kLeastDamping);
  return 0.5 * step.dot(damped.cwiseProduct(step) - b);
}

}  // namespace lintel
