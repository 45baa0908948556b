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

/// d residual / d tangent of the landmark; `plus`: the Jacobian of its manifold's Plus.
template <class Target>
Eigen::Matrix<double, Target::kRows, Target::kTangent> tangentJacobian(const ImageLinearisation<Target>& l,
                                                                       const RowMajorMatrix& plus) {
  if constexpr (Target::kColumns == Target::kTangent)
    return l.d_target;
  else
    return l.d_target * plus.topLeftCorner<Target::kSize, Target::kTangent>();
}

/// S with S S^T = H^-1; a pseudo-inverse where H has no information.
template <int T>
Eigen::Matrix<double, T, T> inverseRoot(Eigen::Matrix<double, T, T> H, double damping) {
  if (damping > 0) {
    for (int i = 0; i < T; ++i) H(i, i) += damping * std::max(H(i, i), kLeastDamping);
    if (const auto root = inverseRootLlt<T>(H)) return *root;
  }
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
double LandmarkBlock<Target>::linearise(const std::vector<CameraView>& views, const double* correction,
                                        const CameraLayout& layout, CameraEquations& eq) {
  H.setZero();
  b.setZero();
  W_intrinsics.setZero();
  RowMajorMatrix plus(Target::kSize, T);
  manifoldOf(kKindOf<Target>)->PlusJacobian(block, plus.data());
  double sum = 0, weight;
  for (Sighting& s : sightings) {
    s.factor->linearise(views[static_cast<std::size_t>(s.camera)], correction, block, true, s.linearised);
    sum += robustCost(loss, s.linearised.residual.squaredNorm(), weight);
  }
  sum = trackCost(2 * sum, weight);
  for (Sighting& s : sightings) addSighting(s, weight, plus, layout, eq);
  if (tie) sum += addTie(layout, eq);
  return sum;
}

template <class Target>
void LandmarkBlock<Target>::addSighting(Sighting& sighting, double track_weight, const RowMajorMatrix& plus,
                                        const CameraLayout& layout, CameraEquations& eq) {
  const ImageLinearisation<Target>& l = sighting.linearised;
  double weight;
  robustCost(loss, l.residual.squaredNorm(), weight);
  const double root = std::sqrt(weight * track_weight);
  const Eigen::Matrix<double, Target::kRows, T> J = root * landmark_block::tangentJacobian(l, plus);
  const Eigen::Matrix<double, Target::kRows, kCameraTangent> Jc = root * l.d_camera;
  const Eigen::Matrix<double, Target::kRows, kIntrinsicsSize> Ji = root * l.d_intrinsics;
  const Eigen::Matrix<double, Target::kRows, 1> r = root * l.residual;
  H.noalias() += J.transpose() * J;
  b.noalias() += J.transpose() * r;
  W_intrinsics.noalias() += Ji.transpose() * J;
  sighting.W.noalias() = Jc.transpose() * J;
  const Eigen::Index at = layout.camera(sighting.camera), intrinsics = layout.intrinsics();
  eq.H.block<kCameraTangent, kCameraTangent>(at, at).noalias() += Jc.transpose() * Jc;
  eq.H.block<kIntrinsicsSize, kCameraTangent>(intrinsics, at).noalias() += Ji.transpose() * Jc;
  eq.H.block<kIntrinsicsSize, kIntrinsicsSize>(intrinsics, intrinsics).noalias() += Ji.transpose() * Ji;
  eq.b.segment<kCameraTangent>(at).noalias() += Jc.transpose() * r;
  eq.b.segment<kIntrinsicsSize>(intrinsics).noalias() += Ji.transpose() * r;
}

template <class Target>
void LandmarkBlock<Target>::eliminate(double damping, const CameraLayout& layout, CameraEquations& eq) {
  inverse_root = landmark_block::inverseRoot<T>(H, damping);
  const Eigen::Matrix<double, T, 1> y = inverse_root.transpose() * b;
  const Eigen::Index intrinsics = layout.intrinsics();
  Y_intrinsics.noalias() = W_intrinsics * inverse_root;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    Sighting& a = sightings[i];
    a.Y.noalias() = a.W * inverse_root;
    const Eigen::Index at = layout.camera(a.camera);
    for (std::size_t j = 0; j <= i; ++j) {
      const Sighting& other = sightings[j];
      eq.H.block<kCameraTangent, kCameraTangent>(at, layout.camera(other.camera)).noalias() -=
          a.Y * other.Y.transpose();
    }
    eq.H.block<kIntrinsicsSize, kCameraTangent>(intrinsics, at).noalias() -= Y_intrinsics * a.Y.transpose();
    eq.b.segment<kCameraTangent>(at).noalias() -= a.Y * y;
  }
  eq.H.block<kIntrinsicsSize, kIntrinsicsSize>(intrinsics, intrinsics).noalias() -=
      Y_intrinsics * Y_intrinsics.transpose();
  eq.b.segment<kIntrinsicsSize>(intrinsics).noalias() -= Y_intrinsics * y;
  if (tie) eliminateTie(y, layout, eq);
}

template <class Target>
double LandmarkBlock<Target>::backSubstitute(const Eigen::VectorXd& camera_step, double damping,
                                             const CameraLayout& layout) {
  Eigen::Matrix<double, T, 1> y = inverse_root.transpose() * b;
  for (const Sighting& s : sightings)
    y += s.Y.transpose() * camera_step.segment<kCameraTangent>(layout.camera(s.camera));
  y += Y_intrinsics.transpose() * camera_step.segment<kIntrinsicsSize>(layout.intrinsics());
  if (tie) y += Y_direction.transpose() * camera_step.segment<kDirectionTangent>(layout.target(direction));
  step = -inverse_root * y;
  const auto damped = damping * H.diagonal().cwiseMax(landmark_block::kLeastDamping);
  return 0.5 * step.dot(damped.cwiseProduct(step) - b);
}

}  // namespace lintel
