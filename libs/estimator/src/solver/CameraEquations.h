// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <map>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/factors/CameraView.h"

namespace lintel {

/// Normal equations over cameras (6 each, in the order of the window's frames), correction without
/// the time offset (7), kept targets.
struct CameraEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// Where the columns of CameraEquations lie. Kept targets are what images see and nobody eliminates: shared directions,
/// and landmarks that stay among the states.
struct CameraLayout {
  int cameras = 0;
  std::vector<BlockKey> kept;
  std::vector<const double*> kept_blocks;
  std::vector<Eigen::Index> kept_offsets{0};  ///< one more entry for the end

  Eigen::Index camera(int k) const { return Eigen::Index{kCameraTangent} * k; }
  Eigen::Index correction() const { return Eigen::Index{kCameraTangent} * cameras; }
  Eigen::Index target(int k) const {
    return correction() + kSightingCorrection + kept_offsets[static_cast<std::size_t>(k)];
  }
  Eigen::Index size() const { return target(static_cast<int>(kept.size())); }
  const double* block(int k) const { return kept_blocks[static_cast<std::size_t>(k)]; }
};

/// Robust cost of a squared norm, and the weight of its residual; no loss: half the square, 1.
inline double robustCost(const ceres::LossFunction* loss, double squared, double& weight) {
  weight = 1;
  if (!loss) return 0.5 * squared;
  double rho[3];
  loss->Evaluate(squared, rho);
  weight = rho[1];
  return 0.5 * rho[0];
}

}  // namespace lintel
