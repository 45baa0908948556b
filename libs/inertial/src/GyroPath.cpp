// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/GyroPath.h"

#include <algorithm>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr double kLargestGap_s = 0.05;

}  // namespace

GyroPath::GyroPath(const ImuBatch& imu, const Eigen::Vector3d& bias_gyro) : imu_(imu), bias_gyro_(bias_gyro) {
  R_b0_bk_.push_back(Eigen::Quaterniond::Identity());
  gaps_.push_back(0);
  for (std::size_t i = 1; i < imu.size(); ++i) {
    const double dt = 1e-9 * static_cast<double>(imu[i].t_ns - imu[i - 1].t_ns);
    R_b0_bk_.push_back((R_b0_bk_.back() * turn(i, dt)).normalized());
    gaps_.push_back(gaps_.back() + (dt > kLargestGap_s || imu[i].bridged));
  }
}

bool GyroPath::covers(std::int64_t from_ns, std::int64_t to_ns) const {
  if (imu_.empty() || from_ns < imu_.front().t_ns || to_ns > imu_.back().t_ns) return false;
  return gaps_[firstNotBefore(to_ns)] == gaps_[firstNotBefore(from_ns)];
}

Eigen::Quaterniond GyroPath::at(std::int64_t t_ns) const {
  const std::size_t k = firstNotBefore(t_ns);
  if (k == 0) return R_b0_bk_.front();
  const double dt = 1e-9 * static_cast<double>(t_ns - imu_[k - 1].t_ns);
  return R_b0_bk_[k - 1] * turn(k, dt);
}

Eigen::Quaterniond GyroPath::turn(std::size_t k, double dt) const {
  return expRotation((0.5 * (imu_[k].gyro + imu_[k - 1].gyro) - bias_gyro_) * dt);
}

std::size_t GyroPath::firstNotBefore(std::int64_t t_ns) const {
  const auto it = std::lower_bound(imu_.begin(), imu_.end(), t_ns,
                                   [](const ImuSample& sample, std::int64_t t) { return sample.t_ns < t; });
  return std::min<std::size_t>(static_cast<std::size_t>(it - imu_.begin()), imu_.size() - 1);
}

}  // namespace lintel
