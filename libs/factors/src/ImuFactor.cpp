// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/ImuFactor.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

template <int Cols>
using Jacobian15 = Eigen::Matrix<double, 15, Cols, Eigen::RowMajor>;

enum Row {
  kTheta = Preintegration::kTheta,
  kV = Preintegration::kVelocity,
  kP = Preintegration::kPosition,
  kBg = 9,
  kBa = 12
};

}  // namespace

ImuFactor::ImuFactor(std::shared_ptr<const Preintegration> preintegration)
    : preintegration_(std::move(preintegration)) {
  const Eigen::Matrix<double, 9, 9> information = preintegration_->covariance().inverse();
  sqrt_information_ = information.llt().matrixU();
  const double root_dt = std::sqrt(preintegration_->dt_s());
  gyro_walk_weight_ = 1.0 / (preintegration_->noise().gyro_walk * root_dt);
  const double correlated = preintegration_->noise().accel_correlated;
  if (correlated > 0) kept_ = std::exp(-preintegration_->dt_s() / kAccelCorrelation_s);
  accel_walk_weight_ =
      1.0 / std::hypot(preintegration_->noise().accel_walk * root_dt, correlated * std::sqrt(1 - kept_ * kept_));
}

bool ImuFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Pose T_w_bi = poseFromBlock(parameters[0]), T_w_bj = poseFromBlock(parameters[2]);
  const Eigen::Vector3d v_i = velocityOf(parameters[1]), v_j = velocityOf(parameters[3]);
  const ImuBias bias_i = biasOf(parameters[1]), bias_j = biasOf(parameters[3]);
  const double dt = preintegration_->dt_s();
  const auto delta = preintegration_->corrected(bias_i);
  const Eigen::Matrix3d R_bi_w = T_w_bi.R().transpose();
  const Eigen::Vector3d g_w = preintegration_->gravityW();
  const Eigen::Vector3d velocity_change = R_bi_w * (v_j - v_i - g_w * dt);
  const Eigen::Vector3d position_change = R_bi_w * (T_w_bj.p - T_w_bi.p - v_i * dt - 0.5 * g_w * dt * dt);

  Eigen::Map<Eigen::Matrix<double, 15, 1>> r(residuals);
  r.segment<3>(kTheta) = logRotation(delta.delta_R.conjugate() * T_w_bi.q.conjugate() * T_w_bj.q);
  r.segment<3>(kV) = velocity_change - delta.delta_v;
  r.segment<3>(kP) = position_change - delta.delta_p;
  r.segment<3>(kBg) = gyro_walk_weight_ * (bias_j.gyro - bias_i.gyro);
  const Eigen::Map<const Eigen::Vector3d> mean(parameters[4]);
  r.segment<3>(kBa) = accel_walk_weight_ * (bias_j.accel - mean - kept_ * (bias_i.accel - mean));
  const Eigen::Vector3d r_theta = r.segment<3>(kTheta);
  r.head<9>() = sqrt_information_ * r.head<9>();
  if (!jacobians) return true;

  const Eigen::Matrix3d Jr_inverse = rightJacobianInverse(r_theta);
  const Eigen::Matrix3d R_bj_bi = (T_w_bj.q.conjugate() * T_w_bi.q).toRotationMatrix();
  if (jacobians[0]) {
    Eigen::Matrix<double, 9, 6> J = Eigen::Matrix<double, 9, 6>::Zero();
    J.block<3, 3>(kTheta, 3) = -Jr_inverse * R_bj_bi;
    J.block<3, 3>(kV, 3) = skew(velocity_change);
    J.block<3, 3>(kP, 3) = skew(position_change);
    J.block<3, 3>(kP, 0) = -R_bi_w;
    Eigen::Map<Jacobian15<7>> out(jacobians[0]);
    out.setZero();
    out.topLeftCorner<9, 3>() = sqrt_information_ * J.leftCols<3>();
    out.topRightCorner<9, 4>() = sqrt_information_ * J.rightCols<3>() * rotationLift(T_w_bi.q);
  }
  if (jacobians[1]) {
    Eigen::Matrix<double, 9, 9> J = Eigen::Matrix<double, 9, 9>::Zero();
    J.block<3, 3>(kV, kVelocityAt) = -R_bi_w;
    J.block<3, 3>(kP, kVelocityAt) = -R_bi_w * dt;
    const auto& bias_jacobian = preintegration_->biasJacobian();
    // r_theta = Log(Exp(-J_g db) ...): its derivative passes through the residual rotation and Jr of the correction
    J.block<3, 3>(kTheta, kBiasGyroAt) = -Jr_inverse * expRotation(r_theta).toRotationMatrix().transpose() *
                                         rightJacobian(delta.delta_theta) * bias_jacobian.block<3, 3>(kTheta, 0);
    J.block<6, 6>(kV, kBiasGyroAt) = -bias_jacobian.bottomRows<6>();
    Eigen::Map<Jacobian15<9>> out(jacobians[1]);
    out.setZero();
    out.topRows<9>() = sqrt_information_ * J;
    out.block<3, 3>(kBg, kBiasGyroAt).diagonal().setConstant(-gyro_walk_weight_);
    out.block<3, 3>(kBa, kBiasAccelAt).diagonal().setConstant(-kept_ * accel_walk_weight_);
  }
  if (jacobians[2]) {
    Eigen::Map<Jacobian15<7>> out(jacobians[2]);
    out.setZero();
    out.topLeftCorner<9, 3>() = sqrt_information_.middleCols<3>(kP) * R_bi_w;
    out.topRightCorner<9, 4>() = sqrt_information_.middleCols<3>(kTheta) * Jr_inverse * rotationLift(T_w_bj.q);
  }
  if (jacobians[3]) {
    Eigen::Map<Jacobian15<9>> out(jacobians[3]);
    out.setZero();
    out.topLeftCorner<9, 3>() = sqrt_information_.middleCols<3>(kV) * R_bi_w;
    out.block<3, 3>(kBg, kBiasGyroAt).diagonal().setConstant(gyro_walk_weight_);
    out.block<3, 3>(kBa, kBiasAccelAt).diagonal().setConstant(accel_walk_weight_);
  }
  if (jacobians[4]) {
    Eigen::Map<Jacobian15<kMeanBiasSize>> out(jacobians[4]);
    out.setZero();
    out.bottomRows<3>().diagonal().setConstant((kept_ - 1) * accel_walk_weight_);
  }
  return true;
}

}  // namespace lintel
