// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/EpipolarRotation.h"

#include <Eigen/LU>
#include <cmath>

#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

/// The direction that the normals are most perpendicular to, given weights from the previous round.
Eigen::Vector3d translationDirection(const std::vector<Eigen::Vector3d>& normals, double width) {
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& n : normals) {
      const double e = round == 0 ? 0 : n.dot(t) / width;
      M += n * n.transpose() / (1 + e * e);
    }
    t = symmetricEigen<3>(M).vectors.col(0);
  }
  return t;
}

void addPair(const FramePair& pair, const Eigen::Vector3d& bias_gyro, double width_rad, EpipolarSystem& system) {
  const Eigen::Vector3d theta = pair.d_theta_d_bias * bias_gyro;
  const Eigen::Matrix3d R = (pair.R_a_b * expRotation(theta)).toRotationMatrix();
  const Eigen::Matrix3d d_theta = rightJacobian(theta) * pair.d_theta_d_bias;
  std::vector<Eigen::Vector3d> normals;
  for (const auto& [a, u] : pair.rays) normals.push_back(a.cross(R * u));
  const Eigen::Vector3d t = translationDirection(normals, width_rad);
  const Eigen::Matrix<double, 3, 2> across = tangentBasis(t);
  Eigen::Matrix2d Htt = Eigen::Matrix2d::Identity() * 1e-12;
  Eigen::Matrix<double, 4, 2> Hbt = Eigen::Matrix<double, 4, 2>::Zero();
  Eigen::Vector2d bt = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double e = t.dot(normals[i]), scaled = e / width_rad, w = 1 / (1 + scaled * scaled);
    // t . (a x dR u) = (t x a) . dR u,  dR u = -R (u x dtheta)
    const auto& [a, u] = pair.rays[i];
    Eigen::RowVector4d J = Eigen::RowVector4d::Zero();
    J.head<3>() = -(R.transpose() * t.cross(a)).cross(u).transpose() * d_theta;
    if (!pair.d_rays_d_readout.empty()) {
      const auto& [d_a, d_u] = pair.d_rays_d_readout[i];
      J(3) = t.dot(d_a.cross(R * u) + a.cross(R * d_u));
    }
    const Eigen::RowVector2d Jt = normals[i].transpose() * across;
    system.H += w * J.transpose() * J;
    system.b += w * J.transpose() * e;
    Htt += w * Jt.transpose() * Jt;
    Hbt += w * J.transpose() * Jt;
    bt += w * Jt.transpose() * e;
    system.sum += w * e * e;
    system.weights += w;
    system.cost += width_rad * width_rad * std::log1p(scaled * scaled);
  }
  // the translation's direction is correlated with the bias: it is eliminated, as alternating steps would converge
  // slowly
  const Eigen::Matrix<double, 4, 2> gain = Hbt * Htt.inverse();
  system.H -= gain * Hbt.transpose();
  system.b -= gain * bt;
}

}  // namespace

EpipolarSystem epipolarSystem(const std::vector<FramePair>& pairs, const Eigen::Vector3d& bias_gyro, double width_rad) {
  EpipolarSystem system;
  for (const FramePair& pair : pairs) addPair(pair, bias_gyro, width_rad, system);
  return system;
}

}  // namespace lintel
