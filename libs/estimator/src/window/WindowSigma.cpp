// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowSigma.h"

#include "solver/Marginals.h"
#include "solver/WindowSolver.h"
#include "window/WindowFactors.h"

namespace lintel {

namespace {

NormalEquations informationOf(SlidingWindow& window, const EstimatorParams& params, const Pose& T_b_c_calibrated) {
  WindowFactors factors(window, params.factors);
  factors.addAll(params, T_b_c_calibrated);
  ReducedSystem system(window, factors.factors(), {}, {});
  holdCalibration(system, params.calibration);
  system.linearise();
  return system.eliminate();
}

Eigen::Matrix<double, 14, 14> jointCovariance(const Marginals& marginals) {
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals.size(), kPoseTangent + kCorrectionSize);
  const Eigen::Index extrinsics = marginals.offsetOf({BlockKey::kExtrinsics, 0});
  if (extrinsics >= 0) F.block<kPoseTangent, kPoseTangent>(extrinsics, 0).setIdentity();
  const Eigen::Index correction = marginals.offsetOf({BlockKey::kCorrection, 0});
  if (correction >= 0) F.block<kCorrectionSize, kCorrectionSize>(correction, kPoseTangent).setIdentity();
  const Eigen::MatrixXd halves = marginals.halves(F);
  return halves.transpose() * halves;
}

}  // namespace

WindowSigma windowSigma(const SlidingWindow& window, const EstimatorParams& params, const Pose& T_b_c_calibrated) {
  SlidingWindow copy = window;  // a system may move the blocks it is given
  const NormalEquations equations = informationOf(copy, params, T_b_c_calibrated);
  WindowSigma sigma;
  constexpr double kFloor = 1e-6;
  const Marginals marginals(equations, kFloor);
  if (!marginals.ok()) return sigma;
  const Eigen::VectorXd motion = marginals.sigmas({BlockKey::kMotion, window.frames.back().id});
  if (motion.size() == kMotionSize) sigma.bias = {motion.segment<3>(kBiasGyroAt), motion.segment<3>(kBiasAccelAt)};
  const Eigen::VectorXd pose = marginals.sigmas({BlockKey::kExtrinsics, 0});
  if (params.calibration.refine_extrinsics && pose.size() == kPoseTangent) {
    sigma.calibration.p_b_c_m = pose.head<3>();
    sigma.calibration.R_b_c_rad = pose.tail<3>();
  }
  const Eigen::VectorXd axes = marginals.sigmas({BlockKey::kAxes, 0});
  if (params.calibration.refine_axes && axes.size() == kAxesSize) {
    const ImuAxes of_axes = axesFromBlock(axes.data(), Eigen::Vector3d::Zero());
    sigma.calibration.accelerometer_axes = of_axes.A;
    sigma.calibration.gyroscope_axes = of_axes.G;
  }
  const Eigen::VectorXd correction = marginals.sigmas({BlockKey::kCorrection, 0});
  if (correction.size() != kCorrectionSize) return sigma;
  sigma.calibration.covariance = jointCovariance(marginals);
  if (params.calibration.refine_camera) sigma.calibration.camera = correction.head<6>();
  if (params.calibration.refine_readout) sigma.calibration.readout_s = correction[kReadoutAt];
  if (params.calibration.refine_time_offset) sigma.calibration.time_offset_s = correction[kTimeOffsetAt];
  return sigma;
}

}  // namespace lintel
