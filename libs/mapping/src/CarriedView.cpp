// SPDX-License-Identifier: BSD-3-Clause
#include "CarriedView.h"

#include "lintel/geometry/Rotation.h"

namespace lintel {

Carriage::Carriage(const Pose& T_w_b, const Pose& T_w_a, const Pose& T_w_n, double share)
    : share_(share),
      R_a_b_(T_w_a.q.conjugate() * T_w_b.q),
      c_a_(T_w_a.q.conjugate() * (T_w_b.p - (1 - share) * T_w_a.p - share * T_w_n.p)) {}

Pose Carriage::pose(const Pose& T_w_a, const Eigen::Vector3d& p_w_n, double scale) const {
  return {T_w_a.q * R_a_b_, (1 - share_) * T_w_a.p + share_ * p_w_n + scale * (T_w_a.q * c_a_)};
}

template <class Target>
bool CarriedView<Target>::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  using PoseJacobian = Eigen::Matrix<double, Target::kRows, kPoseSize, Eigen::RowMajor>;
  const Pose T_w_a = poseFromBlock(parameters[0]);
  const double scale = *parameters[5];
  const PoseBlock carried = toBlock(carriage_.pose(T_w_a, Eigen::Vector3d::Map(parameters[4]), scale));
  const double* blocks[] = {carried.data(), parameters[1], parameters[2], parameters[3]};
  if (!jacobians) return view_.Evaluate(blocks, residuals, nullptr);
  PoseJacobian by_pose;
  double* wanted[] = {by_pose.data(), jacobians[1], jacobians[2], jacobians[3]};
  if (!view_.Evaluate(blocks, residuals, wanted)) return false;
  const Eigen::Matrix<double, Target::kRows, 3> by_p = by_pose.template leftCols<3>();
  if (jacobians[0]) {
    const Eigen::Matrix<double, Target::kRows, 3> by_theta =
        by_pose.template rightCols<4>() * rotationPlus(Eigen::Quaterniond(carried.template tail<4>()));
    Eigen::Map<PoseJacobian> J(jacobians[0]);
    J.template leftCols<3>() = (1 - carriage_.share()) * by_p;
    J.template rightCols<4>() = (by_theta * carriage_.rotation().toRotationMatrix().transpose() -
                                 scale * by_p * T_w_a.R() * skew(carriage_.offset())) *
                                rotationLift(T_w_a.q);
  }
  if (jacobians[4])
    Eigen::Map<PoseJacobian>{jacobians[4]} << carriage_.share() * by_p, Eigen::Matrix<double, Target::kRows, 4>::Zero();
  if (jacobians[5])
    Eigen::Map<Eigen::Matrix<double, Target::kRows, kCarriageScaleSize>>{jacobians[5]} =
        by_p * (T_w_a.q * carriage_.offset());
  return true;
}

template class CarriedView<PointTarget>;
template class CarriedView<LineTarget>;

}  // namespace lintel
