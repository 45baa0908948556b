// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lintel/factors/FrameMotion.h"
#include "lintel/factors/Manifolds.h"
#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/Rotation.h"

namespace lintel::testing {

inline const PoseManifold kPoseManifold;
inline const LineManifold kLineManifold;

/// Analytic against numeric Jacobians in the tangent spaces.
inline void expectGradients(const ceres::CostFunction& cost, const std::vector<const ceres::Manifold*>& manifolds,
                            const std::vector<const double*>& blocks, double tolerance = 1e-6) {
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-5;  // the default 1e-2 jumps over a line's own extent
  ceres::GradientChecker checker(&cost, &manifolds, options);
  ceres::GradientChecker::ProbeResults results;
  checker.Probe(blocks.data(), tolerance, &results);
  ASSERT_TRUE(results.return_value);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    // relative to the block's largest entry: a component that is exactly zero has no relative error of its own
    const Eigen::MatrixXd difference = results.local_jacobians[i] - results.local_numeric_jacobians[i];
    const double scale = std::max(1e-3, results.local_numeric_jacobians[i].cwiseAbs().maxCoeff());
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), tolerance * scale) << "block " << i << "\n" << results.error_log;
  }
}

/// Two poses, extrinsics and a correction of the calibration.
struct Scene {
  PoseBlock T_w_bi = toBlock(Pose{expRotation({0.1, -0.2, 0.3}), {0.5, 0.2, -0.1}});
  PoseBlock T_w_bj = toBlock(Pose{expRotation({0.15, -0.1, 0.4}), {0.9, 0.3, 0.1}});
  PoseBlock T_b_c = toBlock(Pose{expRotation({0.02, 0.01, 1.55}), {-0.02, -0.06, 0.01}});
  CorrectionBlock correction = withReadout(0);  // the first order in it is exact there

  static CorrectionBlock withReadout(double readout_s) {
    CorrectionBlock c = 0.01 * CorrectionBlock::Ones();
    c[kReadoutAt] = readout_s;
    return c;
  }
};

inline const FrameMotion kMotion{{0.5, -0.3, 0.8}, {0.3, -0.6, 0.2}};

}  // namespace lintel::testing
