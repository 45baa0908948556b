// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "lintel/core/Frame.h"

namespace lintel {

/// How an IMU turned since its first sample, by its gyroscope without its bias [rad/s], at any time in between. The
/// samples ascend in time and must outlive it.
class GyroPath {
 public:
  explicit GyroPath(const ImuBatch& imu, const Eigen::Vector3d& bias_gyro = Eigen::Vector3d::Zero());

  /// Whether there are samples from one time to another, without a gap of more than 50 ms, bridged or not.
  bool covers(std::int64_t from_ns, std::int64_t to_ns) const;

  /// Rotation from the body at a time within the samples to the body at the first one.
  Eigen::Quaterniond at(std::int64_t t_ns) const;

 private:
  std::size_t firstNotBefore(std::int64_t t_ns) const;
  /// In `dt` seconds between sample `k` and the one before.
  Eigen::Quaterniond turn(std::size_t k, double dt) const;

  const ImuBatch& imu_;
  Eigen::Vector3d bias_gyro_;
  std::vector<Eigen::Quaterniond> R_b0_bk_;
  std::vector<int> gaps_;  ///< how many there are before a sample
};

}  // namespace lintel
