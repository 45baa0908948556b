// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/GyroAlignment.h"

#include <cmath>
#include <map>

#include "initialisation/EpipolarRotation.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

std::vector<std::map<TrackId, Eigen::Vector3d>> raysInBody(const SlidingWindow& window) {
  std::map<FrameId, std::size_t> index;
  for (std::size_t i = 0; i < window.frames.size(); ++i) index[window.frames[i].id] = i;
  std::vector<std::map<TrackId, Eigen::Vector3d>> rays(window.frames.size());
  const Eigen::Quaterniond R_b_c = window.T_b_c().q;
  for (const auto& [id, track] : window.points)
    for (const PointSighting& s : track.sightings) rays[index.at(s.frame)][id] = R_b_c * s.observation.ray.normalized();
  return rays;
}

std::vector<FramePair> windowPairs(const SlidingWindow& window) {
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

}  // namespace

GyroAlignment alignGyro(const SlidingWindow& window) {
  constexpr double kWidth_rad = 0.004;     // about two pixels of EuRoC's camera
  constexpr double kSettled_rad_s = 1e-5;  // far below what a start leaves to be refined
  GyroAlignment result;
  const std::vector<FramePair> pairs = windowPairs(window);
  if (pairs.size() < 5) return result;
  for (int iteration = 0; iteration < 15; ++iteration) {
    const EpipolarSystem system = epipolarSystem(pairs, result.bias_gyro, kWidth_rad);
    const Eigen::Vector3d step = -solveLdlt<3>(system.H.topLeftCorner<3, 3>(), system.b.head<3>());
    result.bias_gyro += step;
    result.rms_rad = std::sqrt(system.sum / system.weights);
    if (step.norm() < kSettled_rad_s) break;
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
