// SPDX-License-Identifier: BSD-3-Clause
#include "solver/LandmarkBlockDefinitions.h"

namespace lintel {

/// Adds the residual that ties a line to its direction.
template <>
double LandmarkBlock<LineTarget>::addTie(const CameraLayout& layout, CameraEquations& eq) {
  const double* direction_block = layout.block(direction);
  const double* blocks[] = {block, direction_block};
  Eigen::Vector3d r;
  Eigen::Matrix<double, 3, kLineSize, Eigen::RowMajor> J_line;
  Eigen::Matrix<double, 3, kDirectionSize, Eigen::RowMajor> J_direction;
  double* jacobians[] = {J_line.data(), J_direction.data()};
  tie->cost->Evaluate(blocks, r.data(), jacobians);
  double weight;
  const double cost = robustCost(tie->loss, r.squaredNorm(), weight);
  RowMajorMatrix plus(kLineSize, kLineTangent), plus_direction(kDirectionSize, kDirectionTangent);
  manifoldOf(BlockKey::kLine)->PlusJacobian(block, plus.data());
  manifoldOf(BlockKey::kDirection)->PlusJacobian(direction_block, plus_direction.data());
  const Eigen::Matrix<double, 3, kLineTangent> J = J_line * plus;
  const Eigen::Matrix<double, 3, kDirectionTangent> Jd = J_direction * plus_direction;
  H += weight * J.transpose() * J;
  b += weight * J.transpose() * r;
  W.bottomRows<kDirectionTangent>() = weight * Jd.transpose() * J;
  const Eigen::Index at = layout.target(direction);
  eq.H.block<kDirectionTangent, kDirectionTangent>(at, at) += weight * Jd.transpose() * Jd;
  eq.b.segment<kDirectionTangent>(at) += weight * Jd.transpose() * r;
  return cost;
}

template struct LandmarkBlock<LineTarget>;

}  // namespace lintel
