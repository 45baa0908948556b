// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/StructuralFactor.h"

#include <algorithm>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

using LineJacobian = Eigen::Matrix<double, 3, kLineSize, Eigen::RowMajor>;

template <class Jacobian>
void write(double* out, const Jacobian& J) {
  if (out) std::copy_n(J.data(), J.size(), out);
}

/// `d_direction` (3x3) times d (U e2) / d line block.
LineJacobian throughLine(const Eigen::Matrix3d& d_direction, const OrthonormalLine& line) {
  LineJacobian J;
  J.leftCols<4>() = -d_direction * line.U.toRotationMatrix() * skew(Eigen::Vector3d::UnitY()) * rotationLift(line.U);
  J.col(4).setZero();
  return J;
}

}  // namespace

bool SharedDirectionFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const OrthonormalLine line = lineFromBlock(parameters[0]);
  const Eigen::Vector3d d_line = line.U * Eigen::Vector3d::UnitY(), d_group = Eigen::Vector3d::Map(parameters[1]);
  Eigen::Vector3d::Map(residuals) = weight_ * d_line.cross(d_group);
  if (!jacobians) return true;
  write(jacobians[0], throughLine(-weight_ * skew(d_group), line));
  write(jacobians[1], Eigen::Matrix<double, 3, kDirectionSize, Eigen::RowMajor>(weight_ * skew(d_line)));
  return true;
}

bool ParallelLinesFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const OrthonormalLine line_i = lineFromBlock(parameters[0]), line_j = lineFromBlock(parameters[1]);
  const Eigen::Vector3d d_i = line_i.U * Eigen::Vector3d::UnitY(), d_j = line_j.U * Eigen::Vector3d::UnitY();
  Eigen::Vector3d::Map(residuals) = weight_ * d_i.cross(d_j);
  if (!jacobians) return true;
  write(jacobians[0], throughLine(-weight_ * skew(d_j), line_i));
  write(jacobians[1], throughLine(weight_ * skew(d_i), line_j));
  return true;
}

}  // namespace lintel
