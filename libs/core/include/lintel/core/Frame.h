// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace lintel {

/// An 8-bit grey image, row-major, rows packed (stride = width).
struct GrayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height
};

/// One camera image. `t_ns` is its identity.
struct Frame {
  std::int64_t t_ns = 0;
  std::shared_ptr<const GrayImage> image;  ///< never null, shared between stages
};

/// One IMU sample, body frame.
struct ImuSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< angular rate [rad/s]
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< specific force [m/s^2]
  bool bridged = false;  ///< the time since the sample before lies in a drop-out: interpolated, not measured
  /// Densities of what was not measured, as it is beyond the sensor's range: in the place of the sensor's noise where
  /// they are larger.
  float gyro_open = 0, accel_open = 0;  ///< [rad/s/sqrt(Hz)], [m/s^2/sqrt(Hz)]
};

/// The IMU samples from one frame's time to the next one's, both ends included (interpolated linearly where no sample
/// falls on them): the last sample of a batch equals the first of the next. Strictly increasing times.
using ImuBatch = std::vector<ImuSample>;

/// What one step of a recording gives: a frame and the IMU since the frame before.
/// `imu` of the first frame of a stream holds the samples before it (up to 0.5 s), as far as recorded. It is empty
/// when the IMU does not cover the time between the frames (drop-out); the estimator has to cope.
struct FrameWithImu {
  Frame frame;
  ImuBatch imu;
  double reading_ms = 0;  ///< CPU time of reading and decoding, on whichever thread that was
};

}  // namespace lintel
