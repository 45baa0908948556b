// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/StatePriors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "TestWindow.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace test;

/// Squared residuals of all parts at a block.
double squaredAt(const PriorParts& parts, const double* block) {
  double sum = 0;
  for (const auto& part : parts) {
    Eigen::VectorXd r(part.factor->num_residuals());
    EXPECT_TRUE(part.factor->Evaluate(&block, r.data(), nullptr));
    sum += r.squaredNorm();
  }
  return sum;
}

TEST(FirstMotionPrior, HoldsTheAccelerometersBiasToTheMeanBiasAndTheOthersToWhatTheyAre) {
  ImuNoise noise;
  noise.accel_walk = 0.03;
  noise.accel_correlated = 0.04;
  MotionBlock motion;
  motion << 1, 2, 3, 0.01, 0.02, 0.03, 0.3, 0.2, 0.1;
  const auto prior = makeFirstMotionPrior(motion, 0.5, 0.005, noise);
  MotionBlock moved = motion;
  moved[kVelocityAt] += 0.5;
  moved[kBiasGyroAt + 1] -= 0.005;
  const MeanBiasBlock mean = motion.segment<3>(kBiasAccelAt) + Eigen::Vector3d(0, 0, 0.05);
  const double* blocks[] = {moved.data(), mean.data()};
  Eigen::VectorXd r(prior->num_residuals());
  ASSERT_TRUE(prior->Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r[kVelocityAt], 1, 1e-12);
  EXPECT_NEAR(r[kBiasGyroAt + 1], -1, 1e-12);
  EXPECT_NEAR(r[kBiasAccelAt + 2], -1, 1e-12) << "0.05 is the walk of a correlation time and the correlated noise";
  EXPECT_NEAR(r.norm(), std::sqrt(3), 1e-12);
}

TEST(FirstMotionPrior, SaysNothingOfAVelocityThatIsNotKnown) {
  const auto prior =
      makeFirstMotionPrior(MotionBlock::Zero(), std::numeric_limits<double>::infinity(), 0.1, ImuNoise{});
  MotionBlock fast = MotionBlock::Zero();
  fast[kVelocityAt] = 100;
  const MeanBiasBlock mean = MeanBiasBlock::Zero();
  const double* blocks[] = {fast.data(), mean.data()};
  Eigen::VectorXd r(prior->num_residuals());
  ASSERT_TRUE(prior->Evaluate(blocks, r.data(), nullptr));
  EXPECT_EQ(r.norm(), 0);
}

TEST(CalibrationPriors, TogetherAreOverEveryParameterOnce) {
  CalibrationParams p;
  p.refine_readout = true;
  CorrectionBlock correction;
  correction << p.focal_sigma_px, -p.focal_sigma_px, p.centre_sigma_px, p.centre_sigma_px, p.distortion_sigma,
      p.distortion_sigma, -p.readout_sigma_s, p.time_offset_sigma_s;
  EXPECT_NEAR(squaredAt(makeCorrectionPriors(p), correction.data()), kCorrectionSize, 1e-9);
  const Pose T = eurocRig().T_b_c;
  const double a = p.extrinsic_rotation_sigma_rad, b = p.extrinsic_translation_sigma_m;
  const PoseBlock moved = toBlock({T.q * expRotation({a, -a, a}), T.p + Eigen::Vector3d(b, b, -b)});
  EXPECT_NEAR(squaredAt(makeExtrinsicsPriors(p, T), moved.data()), 6, 1e-3);
}

TEST(CalibrationPriors, APartThatIsWrongLeavesTheOthersAlone) {
  const auto parts = makeCorrectionPriors({});
  ASSERT_EQ(parts.size(), 5u);
  CorrectionBlock distortion = CorrectionBlock::Zero();
  distortion[4] = 0.2;
  int touched = 0;
  for (const auto& part : parts) {
    Eigen::VectorXd r(part.factor->num_residuals());
    const double* block = distortion.data();
    ASSERT_TRUE(part.factor->Evaluate(&block, r.data(), nullptr));
    touched += r.norm() > 0;
  }
  EXPECT_EQ(touched, 1);
}

TEST(CalibrationPriors, WhatIsNotRefinedIsHeldWithoutARobustLoss) {
  CalibrationParams p;
  p.refine_readout = true;
  p.refine_time_offset = false;
  const auto parts = makeCorrectionPriors(p);
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_TRUE(parts[0].refined && parts[1].refined && parts[2].refined && parts[3].refined);
  EXPECT_FALSE(parts[4].refined);
  p.refine_time_offset = true;
  p.refine_camera = false;
  const auto others = makeCorrectionPriors(p);
  EXPECT_FALSE(others[0].refined || others[1].refined || others[2].refined);
  EXPECT_TRUE(others[3].refined);
}

CalibrationParams axesParams() {
  CalibrationParams p;
  p.axes_scale_sigma = 0.002;
  p.axes_angle_sigma_rad = 0.01;
  p.gyro_axes_scale_sigma = 0.003;
  p.gyro_axes_angle_sigma_rad = 0.004;
  return p;
}

TEST(AxesPrior, ScalesAndDirectionsHaveTheirOwnSigmas) {
  const auto prior = makeAxesPrior(AxesBlock::Zero(), axesParams()).factor;
  AxesBlock axes = AxesBlock::Zero();
  axes[4] = 0.006;                // the scale of y
  axes[5] = -0.02;                // y shows what is along z
  axes[kGyroAxesAt + 2] = 0.012;  // the scale of the gyroscope's z
  axes[kGyroAxesAt + 3] = 0.004;  // what its x and y have of each other
  Eigen::VectorXd r(prior->num_residuals());
  const double* block = axes.data();
  ASSERT_TRUE(prior->Evaluate(&block, r.data(), nullptr));
  EXPECT_NEAR(r.squaredNorm(), 3 * 3 + 2 * 2 + 4 * 4 + 1, 1e-9);
  EXPECT_NEAR(r.cwiseAbs().maxCoeff(), 4, 1e-12);
}

TEST(AxesPrior, WhereAnElementIsFoundBeyondThreeStandardDeviationsAllOfItsSensorAreLessCertain) {
  AxesBlock found = AxesBlock::Zero();
  found[1] = 0.029;
  const AxesBlock calibrated = axesSigmas(AxesBlock::Zero(), axesParams());
  EXPECT_EQ(axesSigmas(found, axesParams()), calibrated);
  found[3] = -0.031;
  found[8] = 0.0061;
  AxesBlock expected = calibrated;
  expected.head<kGyroAxesAt>() *= 4;
  expected[3] = 8 * calibrated[3];
  expected[8] = 8 * calibrated[8];
  EXPECT_TRUE(axesSigmas(found, axesParams()).isApprox(expected)) << axesSigmas(found, axesParams()).transpose();
  found.setZero();
  found[kGyroAxesAt] = 0.01;
  expected = calibrated;
  expected.tail<kAxesSize - kGyroAxesAt>() *= 4;
  expected[kGyroAxesAt] = 8 * calibrated[kGyroAxesAt];
  EXPECT_TRUE(axesSigmas(found, axesParams()).isApprox(expected)) << axesSigmas(found, axesParams()).transpose();
}

TEST(AxesPrior, HoldsAxesThatAreNotRefined) {
  CalibrationParams params = axesParams();
  params.refine_axes = false;
  const PriorPart part = makeAxesPrior(AxesBlock::Constant(0.1), params);
  EXPECT_FALSE(part.refined);
  AxesBlock axes = AxesBlock::Constant(1e-9);
  Eigen::VectorXd r(kAxesSize);
  const double* block = axes.data();
  ASSERT_TRUE(part.factor->Evaluate(&block, r.data(), nullptr));
  EXPECT_TRUE(r.isApprox(Eigen::VectorXd::Ones(kAxesSize), 1e-9)) << r.transpose();
}

TEST(ParamsFor, ADistortionOfZeroIsNotKnown) {
  Camera camera = eurocRig().camera;
  EstimatorParams params;
  EXPECT_EQ(paramsFor(camera, params).calibration.distortion_sigma, params.calibration.distortion_sigma);
  camera.lens = {};
  EXPECT_EQ(paramsFor(camera, params).calibration.distortion_sigma, 0.1);
  params.calibration.distortion_sigma = 0.3;
  EXPECT_EQ(paramsFor(camera, params).calibration.distortion_sigma, 0.3);
}

TEST(StillPrior, HoldsTheLaterPositionAtTheEarlierOneWhereverThatIs) {
  const PoseBlock earlier = toBlock({expRotation({0.1, -0.2, 0.7}), {1, 2, 3}});
  const auto prior = makeStillPrior(earlier, 0.005);
  // both have moved and turned since: only their distance counts
  const Pose moved{expRotation({0.3, 0.1, -1.2}), {-4, 5, 6}};
  const PoseBlock first = toBlock(moved),
                  second = toBlock({moved.q * expRotation({0.2, 0, 0}), moved.p + Eigen::Vector3d(0.003, 0, 0.004)});
  const double* same[] = {first.data(), first.data()};
  const double* apart[] = {first.data(), second.data()};
  Eigen::Vector3d r;
  ASSERT_TRUE(prior->Evaluate(same, r.data(), nullptr));
  EXPECT_LT(r.norm(), 1e-9);
  ASSERT_TRUE(prior->Evaluate(apart, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 1, 1e-9);
}

}  // namespace
}  // namespace lintel
