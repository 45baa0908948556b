// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The members of LandmarkBlock, for the files that instantiate them: one kind a file, each takes its time to compile.

#include <algorithm>
#include <cmath>

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

template <class Target>
double LandmarkBlock<Target>::cost(const std::vector<CameraView>& views, const double* correction,
                                   const CameraLayout& layout) const {
  double sum = 0, weight;
  ImageLinearisation<Target> l;
  for (const Sighting& s : sightings) {
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, block, false, l);
    sum += robustCost(loss, l.residual.squaredNorm(), weight);
  }
  sum = trackCost(2 * sum, weight);
  if (tie) {
    const double* blocks[] = {block, layout.block(direction)};
    Eigen::Vector3d r;
    tie->cost->Evaluate(blocks, r.data(), nullptr);
    sum += robustCost(tie->loss, r.squaredNorm(), weight);
  }
  return sum;
}

template <class Target>
void LandmarkBlock<Target>::placeRows(const CameraLayout& layout) {
  Eigen::Index rows = 0;
  const auto place = [&](Eigen::Index to, Eigen::Index size) {
    append({rows, to, size}, runs);
    rows += size;
  };
  for (const Sighting& s : sightings) place(layout.camera(s.camera), kCameraTangent);
  place(layout.correction(), kSightingCorrection);
  if (tie) place(layout.target(direction), kDirectionTangent);
  W.resize(rows, T);
}

template <class Target>
double LandmarkBlock<Target>::linearise(const std::vector<CameraView>& views, const double* correction,
                                        const CameraLayout& layout, CameraEquations& eq) {
  H.setZero();
  b.setZero();
  if (runs.empty()) placeRows(layout);
  W.template middleRows<kSightingCorrection>(correctionRow()).setZero();
  PlusJacobian plus;
  manifoldOf(kKindOf<Target>)->PlusJacobian(block, plus.data());
  double sum = 0, weight;
  for (Sighting& s : sightings) {
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, block, true, s.linearised);
    sum += robustCost(loss, s.linearised.residual.squaredNorm(), s.weight);
  }
  sum = trackCost(2 * sum, weight);
  for (std::size_t i = 0; i < sightings.size(); ++i) addSighting(i, weight, plus, layout, eq);
  if (tie) sum += addTie(layout, eq);
  return sum;
}

template <class Target>
void LandmarkBlock<Target>::addSighting(std::size_t i, double track_weight, const PlusJacobian& plus,
                                        const CameraLayout& layout, CameraEquations& eq) {
  const Sighting& sighting = sightings[i];
  const ImageLinearisation<Target>& l = sighting.linearised;
  const double root = std::sqrt(sighting.weight * track_weight);
  using landmark_block::ByRows;  // their transposed ones lie by columns, which makes products of them fast
  const ByRows<Target::kRows, T> J = root * landmark_block::tangentJacobian(l, plus);
  const ByRows<Target::kRows, kCameraTangent> Jc = root * l.d_camera;
  const ByRows<Target::kRows, kSightingCorrection> Ji = root * l.d_correction;
  const Eigen::Matrix<double, Target::kRows, 1> r = root * l.residual;
  H.noalias() += J.transpose() * J;
  b.noalias() += J.transpose() * r;
  W.template middleRows<kSightingCorrection>(correctionRow()).noalias() += Ji.transpose() * J;
  W.template middleRows<kCameraTangent>(kCameraTangent * static_cast<Eigen::Index>(i)).noalias() = Jc.transpose() * J;
  const Eigen::Index at = layout.camera(sighting.camera), correction = layout.correction();
  eq.H.block<kCameraTangent, kCameraTangent>(at, at).noalias() += Jc.transpose() * Jc;
  eq.H.block<kSightingCorrection, kCameraTangent>(correction, at).noalias() += Ji.transpose() * Jc;
  eq.H.block<kSightingCorrection, kSightingCorrection>(correction, correction).noalias() += Ji.transpose() * Ji;
  eq.b.segment<kCameraTangent>(at).noalias() += Jc.transpose() * r;
  eq.b.segment<kSightingCorrection>(correction).noalias() += Ji.transpose() * r;
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
