// SPDX-License-Identifier: BSD-3-Clause
#include "solver/LandmarkBlock.h"

namespace lintel {

template <class Target>
double KeptSighting<Target>::cost(const std::vector<CameraView>& views, const double* correction,
                                  const CameraLayout& layout) const {
  ImageLinearisation<Target> l;
  factor->linearise(views[static_cast<std::size_t>(camera)], correction, typename Target::Value(layout.block(target)),
                    false, l);
  double weight;
  return robustCost(loss, l.residual.squaredNorm(), weight);
}

template <class Target>
double KeptSighting<Target>::linearise(const std::vector<CameraView>& views, const double* correction,
                                       const CameraLayout& layout, CameraEquations& eq) const {
  constexpr int T = Target::kTangent, kTargetAt = kCameraTangent + kSightingCorrection, N = kTargetAt + T;
  ImageLinearisation<Target> l;
  factor->linearise(views[static_cast<std::size_t>(camera)], correction, typename Target::Value(layout.block(target)),
                    true, l);
  double weight;
  const double cost = robustCost(loss, l.residual.squaredNorm(), weight);

  Eigen::Matrix<double, Target::kRows, N> J;
  J.template leftCols<kCameraTangent>() = l.d_camera;
  J.template middleCols<kSightingCorrection>(kCameraTangent) = l.d_correction;
  if constexpr (Target::kColumns == T) {
    J.template rightCols<T>() = l.d_target;
  } else {
    RowMajorMatrix plus(Target::kSize, T);
    manifoldOf(kKindOf<Target>)->PlusJacobian(layout.block(target), plus.data());
    const Eigen::Matrix<double, Target::kRows, T> d_tangent = l.d_target * plus;
    J.template rightCols<T>() = d_tangent;
  }
  const Eigen::Matrix<double, N, Target::kRows> weighted = weight * J.transpose();
  const Eigen::Matrix<double, N, N> H = weighted.lazyProduct(J);
  const Eigen::Matrix<double, N, 1> b = J.transpose().lazyProduct(weight * l.residual);
  const Eigen::Index view = layout.camera(camera), shared = layout.correction(), seen = layout.target(target);
  eq.b.template segment<kCameraTangent>(view) += b.template head<kCameraTangent>();
  eq.b.template segment<kSightingCorrection>(shared) += b.template segment<kSightingCorrection>(kCameraTangent);
  eq.b.template segment<T>(seen) += b.template tail<T>();
  eq.H.template block<kCameraTangent, kCameraTangent>(view, view) +=
      H.template topLeftCorner<kCameraTangent, kCameraTangent>();
  eq.H.template block<kSightingCorrection, kCameraTangent>(shared, view) +=
      H.template block<kSightingCorrection, kCameraTangent>(kCameraTangent, 0);
  eq.H.template block<kSightingCorrection, kSightingCorrection>(shared, shared) +=
      H.template block<kSightingCorrection, kSightingCorrection>(kCameraTangent, kCameraTangent);
  eq.H.template block<T, kCameraTangent>(seen, view) += H.template block<T, kCameraTangent>(kTargetAt, 0);
  eq.H.template block<T, kSightingCorrection>(seen, shared) +=
      H.template block<T, kSightingCorrection>(kTargetAt, kCameraTangent);
  eq.H.template block<T, T>(seen, seen) += H.template bottomRightCorner<T, T>();
  return cost;
}

template struct KeptSighting<PointTarget>;
template struct KeptSighting<LineTarget>;
template struct KeptSighting<DirectionTarget>;

}  // namespace lintel
