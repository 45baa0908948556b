// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/ImageFactor.h"

#include <type_traits>

namespace lintel {

namespace {

template <int Rows, int Columns>
using Block = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;

/// d residual / d pose block (7), where the camera's pose moves by `d_block` with the block's tangent.
template <class Target>
void writePose(const ImageLinearisation<Target>& l, const Eigen::Matrix<double, kCameraTangent, kPoseTangent>& d_block,
               const double* block, double* out) {
  const Eigen::Matrix<double, Target::kRows, kPoseTangent> tangent = l.d_camera * d_block;
  Eigen::Map<Block<Target::kRows, kPoseSize>> J(out);
  J.template leftCols<3>() = tangent.template leftCols<3>();
  J.template rightCols<4>() = tangent.template rightCols<3>() * rotationLift(poseFromBlock(block).q);
}

template <class Target>
void writeTarget(const ImageLinearisation<Target>& l, const double* block, double* out) {
  Eigen::Map<Block<Target::kRows, Target::kSize>> J(out);
  if constexpr (std::is_same_v<Target, LineTarget>) {
    J.template leftCols<4>() = l.d_target.template leftCols<3>() * rotationLift(lineFromBlock(block).U);
    J.col(4) = l.d_target.col(3);
  } else {
    J = l.d_target;
  }
}

}  // namespace

template <class Target>
bool ImageFactor<Target>::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const CameraView view(parameters[0], parameters[1], parameters[2], motion_, jacobians != nullptr);
  ImageLinearisation<Target> l;
  linearise(view, parameters[2], typename Target::Value(parameters[3]), jacobians != nullptr, l);
  Eigen::Map<Eigen::Matrix<double, Target::kRows, 1>>{residuals} = l.residual;
  if (!jacobians) return true;
  if (jacobians[0]) writePose(l, view.d_pose, parameters[0], jacobians[0]);
  if (jacobians[1]) writePose(l, view.d_extrinsics, parameters[1], jacobians[1]);
  if (jacobians[2]) {
    Eigen::Map<Block<Target::kRows, kCorrectionSize>> J(jacobians[2]);
    J.template leftCols<kSightingCorrection>() = l.d_correction;
    J.col(kTimeOffsetAt) = l.d_camera * view.d_offset;
  }
  if (jacobians[3]) writeTarget(l, parameters[3], jacobians[3]);
  return true;
}

template class ImageFactor<PointTarget>;
template class ImageFactor<LineTarget>;
template class ImageFactor<DirectionTarget>;

}  // namespace lintel
