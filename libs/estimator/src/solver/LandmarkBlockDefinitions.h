// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The members of LandmarkBlock, for the files that instantiate them: one kind a file, each takes its time to compile.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "lintel/geometry/SmallMatrices.h"
#include "solver/LandmarkBlock.h"

namespace lintel {

namespace landmark_block {

constexpr double kNoInformation = 1e-8;  // eigenvalues below count as zero; residuals are in standard deviations
constexpr double kLeastDamping = 1e-6;   // times the damping: the least that is added to a diagonal

template <class Matrix>
double* numbersOf(std::vector<Matrix>& matrices) {
  return matrices.empty() ? nullptr : matrices.front().data();
}

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
void LandmarkBlock<Target>::chooseNoise(LandmarkScratch& scratch) {
  std::vector<double> t_s;
  for (const Sighting& s : sightings) t_s.push_back(s.t_s);
  const auto count = static_cast<int>(2 * sightings.size());
  const double determinants = 2.0 * std::max(1, count - T) / count;
  double least = std::numeric_limits<double>::infinity();
  for (const NoiseKind& kind : noise->kinds) {
    Whitener candidate(kind, t_s);
    scratch.whitened = scratch.residuals;
    candidate.whiten(landmark_block::numbersOf(scratch.whitened), 2);
    const double cost = whitenedCost(scratch.whitened, scratch.weights) + determinants * candidate.logDeterminant();
    if (whitener.size() == 0 || cost < least) {
      least = cost;
      mean_square = meanSquare(scratch.whitened);
      whitener = std::move(candidate);
    }
  }
}

/// For each degree of freedom, of all observations but the last: where the camera was then may be what the IMU says, as
/// no solve has seen that image. The others' whitened residuals do not depend on the last one.
template <class Target>
std::optional<double> LandmarkBlock<Target>::meanSquare(const std::vector<Eigen::Vector2d>& whitened) const {
  constexpr std::size_t kLeastSightings = 6;  // fewer say little about their noise
  if (whitened.size() < kLeastSightings) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < whitened.size(); ++i) sum += whitened[i].squaredNorm();
  return sum / (2 * static_cast<double>(whitened.size() - 1) - T);
}

/// The weights are the derivatives of the cost by half the squares of whitened residuals.
template <class Target>
double LandmarkBlock<Target>::whitenedCost(const std::vector<Eigen::Vector2d>& whitened,
                                           std::vector<double>& weights) const {
  weights.resize(whitened.size());
  double sum = 0, track_weight;
  for (std::size_t i = 0; i < whitened.size(); ++i) sum += robustCost(loss, whitened[i].squaredNorm(), weights[i]);
  sum = TrackLoss(noise->freedom).cost(2 * sum, static_cast<int>(2 * whitened.size()), T, track_weight);
  for (double& weight : weights) weight *= track_weight;
  return sum;
}

template <class Target>
double LandmarkBlock<Target>::cost(const std::vector<CameraView>& views, const double* correction,
                                   const CameraLayout& layout, LandmarkScratch& scratch) const {
  scratch.whitened.resize(sightings.size());
  ImageLinearisation<Target> l;
  const typename Target::Value value(block);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& s = sightings[i];
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, value, false, l);
    scratch.whitened[i] = l.residual;
  }
  whitener.whiten(landmark_block::numbersOf(scratch.whitened), 2);
  double sum = whitenedCost(scratch.whitened, scratch.weights);
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
                                        const CameraLayout& layout, LandmarkScratch& scratch, CameraEquations& eq) {
  takeRows(views, correction, scratch);
  if (whitener.size() == 0) chooseNoise(scratch);
  double sum = weighRows(scratch);
  multiplySightings(scratch.rows, scratch.camera_rows, scratch.weighted_rows, scratch.products);
  addProducts(scratch.products, layout, eq);
  whitener.information(scratch.weights.data(), scratch.information);
  addCameraPairs(scratch.camera_rows, scratch.information, camera_places, eq.H);
  if (tie) sum += addTie(layout, eq);
  return sum;
}

template <class Target>
void LandmarkBlock<Target>::takeRows(const std::vector<CameraView>& views, const double* correction,
                                     LandmarkScratch& scratch) const {
  PlusJacobian plus;
  manifoldOf(kKindOf<Target>)->PlusJacobian(block, plus.data());
  const std::size_t n = sightings.size();
  scratch.rows.resize(n);
  scratch.camera_rows.resize(n);
  scratch.residuals.resize(n);
  ImageLinearisation<Target> l;
  const typename Target::Value value(block);
  for (std::size_t i = 0; i < n; ++i) {
    sightings[i].factor->linearise(views[static_cast<std::size_t>(sightings[i].camera)], correction, value, true, l);
    SightingRows& rows = scratch.rows[i];
    rows.template leftCols<T>() = landmark_block::tangentJacobian(l, plus);
    if constexpr (T < kTargetColumns) rows.template middleCols<kTargetColumns - T>(T).setZero();
    rows.template middleCols<kSightingCorrection>(kCorrectionColumn) = l.d_correction;
    rows.col(kResidualColumn) = l.residual;
    scratch.camera_rows[i] = l.d_camera;
    scratch.residuals[i] = l.residual;
  }
}

/// `weights`, and the information times `rows`.
template <class Target>
double LandmarkBlock<Target>::weighRows(LandmarkScratch& scratch) const {
  constexpr int kColumns = 2 * kSightingColumns;  // of both coordinates
  scratch.weighted_rows = scratch.rows;
  double* const rows = landmark_block::numbersOf(scratch.weighted_rows);
  whitener.whiten(rows, kColumns);
  scratch.whitened.resize(sightings.size());
  for (std::size_t i = 0; i < sightings.size(); ++i)
    scratch.whitened[i] = scratch.weighted_rows[i].col(kResidualColumn);
  const double sum = whitenedCost(scratch.whitened, scratch.weights);
  for (std::size_t i = 0; i < sightings.size(); ++i) scratch.weighted_rows[i] *= scratch.weights[i];
  whitener.whitenTransposed(rows, kColumns);
  return sum;
}

/// Sets H, b and W, but for the tie; adds the rest to `eq`.
template <class Target>
void LandmarkBlock<Target>::addProducts(const SightingProducts& products, const CameraLayout& layout,
                                        CameraEquations& eq) {
  const Eigen::Index correction = layout.correction();
  const auto& all = products.all;
  H = all.template topLeftCorner<T, T>().template selfadjointView<Eigen::Upper>();
  b = all.template block<T, 1>(0, kResidualColumn);
  W.template middleRows<kSightingCorrection>(correctionRow()) =
      all.template block<T, kSightingCorrection>(0, kCorrectionColumn).transpose();
  eq.H.block<kSightingCorrection, kSightingCorrection>(correction, correction)
      .template triangularView<Eigen::Lower>() +=
      all.template block<kSightingCorrection, kSightingCorrection>(kCorrectionColumn, kCorrectionColumn).transpose();
  eq.b.segment<kSightingCorrection>(correction) +=
      all.template block<kSightingCorrection, 1>(kCorrectionColumn, kResidualColumn);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const auto& of_camera = products.by_camera[i];
    W.template middleRows<kCameraTangent>(kCameraTangent * static_cast<Eigen::Index>(i)) =
        of_camera.template leftCols<T>();
    eq.H.block<kSightingCorrection, kCameraTangent>(correction, camera_places[i]) +=
        of_camera.template middleCols<kSightingCorrection>(kCorrectionColumn).transpose();
    eq.b.segment<kCameraTangent>(camera_places[i]) += of_camera.col(kResidualColumn);
  }
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
