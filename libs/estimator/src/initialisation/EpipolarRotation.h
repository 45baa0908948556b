// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <utility>
#include <vector>

namespace lintel {

/// The gyro's rotation between two frames and how it depends on the bias, and what both cameras see.
struct FramePair {
  Eigen::Quaterniond R_a_b = Eigen::Quaterniond::Identity();                  // body axes
  Eigen::Matrix3d d_theta_d_bias = Eigen::Matrix3d::Zero();                   // right perturbation of R_a_b
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rays;              // unit, body axes of a and b
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> d_rays_d_readout;  // empty: the readout is known
};

/// Normal equations of the gyro bias [rad/s] and of the readout [s]: the epipolar constraint of all pairs, each pair's
/// direction of translation eliminated.
struct EpipolarSystem {
  Eigen::Matrix4d H = Eigen::Matrix4d::Identity() * 1e-9;
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  double sum = 0, weights = 0;  ///< of the weighted squares, and of the weights
  double cost = 0;              ///< robust: Cauchy [rad^2]
};

/// For rays of width `width_rad` (scale of Cauchy's loss) at a bias.
EpipolarSystem epipolarSystem(const std::vector<FramePair>& pairs, const Eigen::Vector3d& bias_gyro, double width_rad);

}  // namespace lintel
