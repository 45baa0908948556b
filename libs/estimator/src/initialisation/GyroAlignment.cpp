// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/GyroAlignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// The gyro's rotation between two frames and how it depends on the bias, and what both cameras see.
struct FramePair {
  Eigen::Quaterniond R_a_b = Eigen::Quaterniond::Identity();      // body axes
  Eigen::Matrix3d d_theta_d_bias = Eigen::Matrix3d::Zero();       // right perturbation of R_a_b
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rays;  // unit, body axes of a and b
};

std::vector<std::map<TrackId, Eigen::Vector3d>> raysInBody(const SlidingWindow& window) {
  std::map<FrameId, std::size_t> index;
  for (std::size_t i = 0; i < window.frames.size(); ++i) index[window.frames[i].id] = i;
  std::vector<std::map<TrackId, Eigen::Vector3d>> rays(window.frames.size());
  const Eigen::Quaterniond R_b_c = window.T_b_c().q;
  for (const auto& [id, track] : window.points)
    for (const PointSighting& s : track.sightings)
      rays[index.at(s.frame)][id] = R_b_c * s.observation.position.homogeneous().normalized();
  return rays;
}

std::vector<FramePair> makePairs(const SlidingWindow& window) {
  const auto rays = raysInBody(window);
  std::vector<FramePair> pairs;
  const std::size_t n = window.frames.size();
  for (const std::size_t gap : {std::size_t{1}, std::size_t{3}, std::size_t{6}})
    for (std::size_t a = 0; a + gap < n; ++a) {
      FramePair pair;
      for (std::size_t k = a + 1; k <= a + gap; ++k) {
        const Preintegration& imu = *window.frames[k].imu;
        pair.d_theta_d_bias = imu.deltaR().toRotationMatrix().transpose() * pair.d_theta_d_bias +
                              imu.biasJacobian().block<3, 3>(Preintegration::kTheta, 0);
        pair.R_a_b = pair.R_a_b * imu.deltaR();
      }
      for (const auto& [id, ray_a] : rays[a])
        if (auto it = rays[a + gap].find(id); it != rays[a + gap].end()) pair.rays.emplace_back(ray_a, it->second);
      if (pair.rays.size() >= 15) pairs.push_back(std::move(pair));
    }
  return pairs;
}

/// The direction that the normals are most perpendicular to, given weights from the previous round.
Eigen::Vector3d translationDirection(const std::vector<Eigen::Vector3d>& normals, double width) {
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& n : normals) {
      const double e = round == 0 ? 0 : n.dot(t) / width;
      M += n * n.transpose() / (1 + e * e);
    }
    t = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(M).eigenvectors().col(0);
  }
  return t;
}

}  // namespace

GyroAlignment alignGyro(const SlidingWindow& window) {
  constexpr double kWidth_rad = 0.004;  // about two pixels of EuRoC's camera
  GyroAlignment result;
  const std::vector<FramePair> pairs = makePairs(window);
  if (pairs.size() < 5) return result;
  for (int iteration = 0; iteration < 15; ++iteration) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double sum = 0, weights = 0;
    for (const FramePair& pair : pairs) {
      const Eigen::Vector3d theta = pair.d_theta_d_bias * result.bias_gyro;
      const Eigen::Matrix3d R = (pair.R_a_b * expRotation(theta)).toRotationMatrix();
      const Eigen::Matrix3d d_theta = rightJacobian(theta) * pair.d_theta_d_bias;
      std::vector<Eigen::Vector3d> normals;
      for (const auto& [a, u] : pair.rays) normals.push_back(a.cross(R * u));
      const Eigen::Vector3d t = translationDirection(normals, kWidth_rad);
      const Eigen::Matrix<double, 3, 2> across = tangentBasis(t);
      Eigen::Matrix2d Htt = Eigen::Matrix2d::Identity() * 1e-12;
      Eigen::Matrix<double, 3, 2> Hbt = Eigen::Matrix<double, 3, 2>::Zero();
      Eigen::Vector2d bt = Eigen::Vector2d::Zero();
      for (std::size_t i = 0; i < normals.size(); ++i) {
        const double e = t.dot(normals[i]), scaled = e / kWidth_rad, w = 1 / (1 + scaled * scaled);
        // t . (a x dR u),  dR u = -R [u]x dtheta
        const Eigen::RowVector3d J =
            -t.transpose() * skew(pair.rays[i].first) * R * skew(pair.rays[i].second) * d_theta;
        const Eigen::RowVector2d Jt = normals[i].transpose() * across;
        H += w * J.transpose() * J;
        b += w * J.transpose() * e;
        Htt += w * Jt.transpose() * Jt;
        Hbt += w * J.transpose() * Jt;
        bt += w * Jt.transpose() * e;
        sum += w * e * e;
        weights += w;
      }
      // the translation's direction follows the bias: eliminated, else the two would only creep along together
      const Eigen::Matrix<double, 3, 2> gain = Hbt * Htt.inverse();
      H -= gain * Hbt.transpose();
      b -= gain * bt;
    }
    const Eigen::Vector3d step = -H.ldlt().solve(b);
    result.bias_gyro += step;
    result.rms_rad = std::sqrt(sum / weights);
    if (step.norm() < 1e-6) break;
  }
  result.ok = result.bias_gyro.allFinite() && result.bias_gyro.norm() < 0.5;
  return result;
}

std::vector<Eigen::Quaterniond> integratedRotations(const SlidingWindow& window) {
  std::vector<Eigen::Quaterniond> R_b0_bk{Eigen::Quaterniond::Identity()};
  for (std::size_t k = 1; k < window.frames.size(); ++k)
    R_b0_bk.push_back((R_b0_bk.back() * window.frames[k].imu->deltaR()).normalized());
  return R_b0_bk;
}

}  // namespace lintel
