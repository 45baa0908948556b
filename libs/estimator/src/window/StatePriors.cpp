// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/StatePriors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lintel {

namespace {

constexpr double kHeld = 1e-9;              // sigma of what is not refined, in its own unit
constexpr double kUnknownDistortion = 0.1;  // k1 and k2 of lenses that are no fisheyes
constexpr double kFree = std::numeric_limits<double>::infinity();

std::unique_ptr<PriorFactor> makeMotionPrior(const MotionBlock& sigma) {
  return makeBlockPrior(std::make_shared<VectorManifold>(kMotionSize), MotionBlock::Zero(), sigma);
}

/// On the `size` tangent components from `at` alone.
PriorPart makePart(std::shared_ptr<const StateManifold> manifold, const Eigen::VectorXd& x_0, int at, int size,
                   bool refined, double sigma) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, manifold->TangentSize());
  A.middleCols(at, size).setIdentity();
  std::vector<PriorBlock> blocks{{std::move(manifold), x_0}};
  A /= refined ? sigma : kHeld;
  return {std::make_unique<PriorFactor>(std::move(blocks), A, Eigen::VectorXd::Zero(size)), refined};
}

}  // namespace

EstimatorParams paramsFor(const Camera& camera, const EstimatorParams& params) {
  EstimatorParams used = scaledTo(camera, params);
  double& sigma = used.calibration.distortion_sigma;
  if (!camera.wide() && camera.lens == Camera().lens) sigma = std::max(sigma, kUnknownDistortion);
  return used;
}

std::unique_ptr<PriorFactor> makeGaugePrior(const PoseBlock& pose) {
  constexpr double kWeight = 1e3;  // a millimetre, a milliradian: stiff, yet no worse conditioned than the rest
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, kPoseTangent);
  A.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * kWeight;
  A.block<1, 3>(3, 3) = Eigen::RowVector3d::UnitZ() * poseFromBlock(pose.data()).R() * kWeight;
  std::vector<PriorBlock> blocks{{std::make_shared<PoseManifold>(), pose}};
  return std::make_unique<PriorFactor>(std::move(blocks), std::move(A), Eigen::VectorXd::Zero(4));
}

PriorParts makeExtrinsicsPriors(const CalibrationParams& p, const Pose& T_b_c_calibrated) {
  const PoseBlock calibrated = toBlock(T_b_c_calibrated);
  const auto manifold = std::make_shared<PoseManifold>();
  PriorParts parts;
  parts.push_back(makePart(manifold, calibrated, 0, 3, p.refine_extrinsics, p.extrinsic_translation_sigma_m));
  parts.push_back(makePart(manifold, calibrated, 3, 3, p.refine_extrinsics, p.extrinsic_rotation_sigma_rad));
  return parts;
}

PriorParts makeCorrectionPriors(const CalibrationParams& p) {
  const CorrectionBlock zero = CorrectionBlock::Zero();
  const auto manifold = std::make_shared<VectorManifold>(kCorrectionSize);
  PriorParts parts;
  parts.push_back(makePart(manifold, zero, 0, 2, p.refine_camera, p.focal_sigma_px));
  parts.push_back(makePart(manifold, zero, 2, 2, p.refine_camera, p.centre_sigma_px));
  parts.push_back(makePart(manifold, zero, 4, 2, p.refine_camera, p.distortion_sigma));
  parts.push_back(makePart(manifold, zero, kReadoutAt, 1, p.refine_readout, p.readout_sigma_s));
  parts.push_back(makePart(manifold, zero, kTimeOffsetAt, 1, p.refine_time_offset, p.time_offset_sigma_s));
  return parts;
}

AxesBlock axesSigmas(const AxesBlock& found, const CalibrationParams& p) {
  constexpr double kRefuted = 3, kWider = 8, kOthers = 4;
  ImuAxes calibrated;
  calibrated.A.setConstant(p.axes_angle_sigma_rad);
  calibrated.A.diagonal().setConstant(p.axes_scale_sigma);
  calibrated.G.setConstant(p.gyro_axes_angle_sigma_rad);
  calibrated.G.diagonal().setConstant(p.gyro_axes_scale_sigma);
  AxesBlock sigmas = toBlock(calibrated);
  const Eigen::Array<bool, kAxesSize, 1> refuted = found.cwiseAbs().array() > kRefuted * sigmas.array();
  for (const auto& [at, size] : {std::pair(0, kGyroAxesAt), std::pair(kGyroAxesAt, kAxesSize - kGyroAxesAt)})
    if (refuted.segment(at, size).any())
      for (int i = at; i < at + size; ++i) sigmas[i] *= refuted[i] ? kWider : kOthers;
  return sigmas;
}

PriorPart makeAxesPrior(const AxesBlock& found, const CalibrationParams& p) {
  const AxesBlock sigmas = p.refine_axes ? axesSigmas(found, p) : AxesBlock::Constant(kHeld);
  return {makeBlockPrior(std::make_shared<VectorManifold>(kAxesSize), AxesBlock::Zero(), sigmas), p.refine_axes};
}

std::unique_ptr<PriorFactor> makeRestPrior(double velocity_sigma) {
  MotionBlock sigma = MotionBlock::Constant(kFree);
  sigma.segment<3>(kVelocityAt).setConstant(velocity_sigma);
  return makeMotionPrior(sigma);
}

std::unique_ptr<PriorFactor> makeStillPrior(const PoseBlock& earlier, double position_sigma) {
  // the earlier pose is the prior's anchor: what is left of the later one is its position relative to that
  const auto manifold = std::make_shared<PoseManifold>();
  std::vector<PriorBlock> blocks{{manifold, earlier, GaugeAction::kPose}, {manifold, earlier, GaugeAction::kPose}};
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 2 * kPoseTangent);
  A.block<3, 3>(0, kPoseTangent) = Eigen::Matrix3d::Identity() / position_sigma;
  return std::make_unique<PriorFactor>(std::move(blocks), std::move(A), Eigen::VectorXd::Zero(3));
}

std::unique_ptr<PriorFactor> makeMeanBiasPrior(const Eigen::Vector3d& mean, const InitializerParams& params) {
  return makeBlockPrior(std::make_shared<VectorManifold>(kMeanBiasSize), mean,
                        MeanBiasBlock::Constant(params.bias_accel_sigma));
}

std::unique_ptr<PriorFactor> makeFirstMotionPrior(const MotionBlock& motion, double velocity_sigma,
                                                  double bias_gyro_sigma, const ImuNoise& noise) {
  const double bias_accel_sigma = std::hypot(noise.accel_correlated, noise.accel_walk * std::sqrt(kAccelCorrelation_s));
  MotionBlock weights;
  weights << Eigen::Vector3d::Constant(1 / velocity_sigma), Eigen::Vector3d::Constant(1 / bias_gyro_sigma),
      Eigen::Vector3d::Constant(1 / bias_accel_sigma);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kMotionSize, kMotionSize + kMeanBiasSize);
  A.diagonal() = weights;
  A.block<3, 3>(kBiasAccelAt, kMotionSize).diagonal().setConstant(-1 / bias_accel_sigma);
  const MeanBiasBlock mean = motion.segment<3>(kBiasAccelAt);  // the difference alone counts
  std::vector<PriorBlock> blocks{{std::make_shared<VectorManifold>(kMotionSize), motion},
                                 {std::make_shared<VectorManifold>(kMeanBiasSize), mean}};
  return std::make_unique<PriorFactor>(std::move(blocks), std::move(A), Eigen::VectorXd::Zero(kMotionSize));
}

}  // namespace lintel
