// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowFactors.h"

#include <gtest/gtest.h>

#include "TestWindow.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace test;

/// Cost of extrinsics that are not as calibrated, twenty standard deviations off in each axis of one of both parts.
double costOff(bool lever_arm, bool scale_known) {
  const Rig rig = eurocRig();
  SlidingWindow window(rig);
  window.scale_known = scale_known;
  const EstimatorParams params;
  WindowFactors factors(window, params.factors);
  factors.addCalibrationPriors(params.calibration, rig.T_b_c);
  Pose off = rig.T_b_c;
  if (lever_arm)
    off.p += 20 * params.calibration.extrinsic_translation_sigma_m * Eigen::Vector3d::Ones();
  else
    off.q = off.q * expRotation(20 * params.calibration.extrinsic_rotation_sigma_rad * Eigen::Vector3d::Ones());
  const PoseBlock block = toBlock(off);
  const double* data = block.data();
  double sum = 0;
  for (const Factor& factor : factors.factors()) {
    if (factor.blocks.front().kind != BlockKey::kExtrinsics) continue;
    Eigen::VectorXd r(factor.cost->num_residuals());
    EXPECT_TRUE(factor.cost->Evaluate(&data, r.data(), nullptr));
    double robust[3] = {r.squaredNorm(), 1, 0};
    if (factor.loss) factor.loss->Evaluate(r.squaredNorm(), robust);
    sum += robust[0];
  }
  return sum;
}

TEST(WindowFactors, ALeverArmMayLeaveItsCalibrationOnceTheScaleIsKnown) {
  EXPECT_NEAR(costOff(true, false), 1200, 1);  // three axes
  EXPECT_LT(costOff(true, true), 60);
}

TEST(WindowFactors, AMountingMayLeaveItsCalibrationFromTheStart) {
  EXPECT_LT(costOff(false, false), 60);
  EXPECT_EQ(costOff(false, false), costOff(false, true));
}

}  // namespace
}  // namespace lintel
