// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/StatePriors.h"

#include <limits>

namespace lintel {

namespace {

constexpr double kHeld = 1e-9;  // sigma of what is not refined, in its own unit
constexpr double kFree = std::numeric_limits<double>::infinity();

std::unique_ptr<PriorFactor> makeMotionPrior(const MotionBlock& sigma) {
  return makeBlockPrior(std::make_shared<VectorManifold>(kMotionSize), MotionBlock::Zero(), sigma);
}

}  // namespace

std::unique_ptr<PriorFactor> makeGaugePrior(const PoseBlock& pose) {
  constexpr double kWeight = 1e3;  // a millimetre, a milliradian: stiff, yet no worse conditioned than the rest
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, kPoseTangent);
  A.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * kWeight;
  A.block<1, 3>(3, 3) = Eigen::RowVector3d::UnitZ() * poseFromBlock(pose.data()).R() * kWeight;
  std::vector<PriorBlock> blocks{{std::make_shared<PoseManifold>(), pose}};
  return std::make_unique<PriorFactor>(std::move(blocks), std::move(A), Eigen::VectorXd::Zero(4));
}

std::unique_ptr<PriorFactor> makeExtrinsicsPrior(const CalibrationParams& p, const Pose& T_b_c_calibrated) {
  Eigen::VectorXd sigma(kPoseTangent);
  sigma << Eigen::Vector3d::Constant(p.refine_extrinsics ? p.extrinsic_translation_sigma_m : kHeld),
      Eigen::Vector3d::Constant(p.refine_extrinsics ? p.extrinsic_rotation_sigma_rad : kHeld);
  return makeBlockPrior(std::make_shared<PoseManifold>(), toBlock(T_b_c_calibrated), sigma);
}

std::unique_ptr<PriorFactor> makeCorrectionPrior(const CalibrationParams& p) {
  CorrectionBlock sigma;
  sigma << p.focal_sigma_px, p.focal_sigma_px, p.centre_sigma_px, p.centre_sigma_px, p.distortion_sigma,
      p.distortion_sigma, p.time_offset_sigma_s;
  if (!p.refine_camera) sigma.head<kTimeOffsetAt>().setConstant(kHeld);
  if (!p.refine_time_offset) sigma[kTimeOffsetAt] = kHeld;
  return makeBlockPrior(std::make_shared<VectorManifold>(kCorrectionSize), CorrectionBlock::Zero(), sigma);
}

std::unique_ptr<PriorFactor> makeRestPrior(double velocity_sigma) {
  MotionBlock sigma = MotionBlock::Constant(kFree);
  sigma.segment<3>(kVelocityAt).setConstant(velocity_sigma);
  return makeMotionPrior(sigma);
}

std::unique_ptr<PriorFactor> makeBiasPrior(const InitializerParams& params) {
  MotionBlock sigma = MotionBlock::Constant(kFree);
  sigma.segment<3>(kBiasGyroAt).setConstant(params.bias_gyro_sigma);
  sigma.segment<3>(kBiasAccelAt).setConstant(params.bias_accel_sigma);
  return makeMotionPrior(sigma);
}

}  // namespace lintel
