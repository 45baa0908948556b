// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// Predicts how the camera turned between two frames from the gyroscope. Its bias (up to 0.1 rad/s, more than 2 px a
/// frame) and how much later than its stamp an image shows the world (up to 0.1 s) are estimated from the motion of the
/// points.
class GyroPrediction {
 public:
  GyroPrediction(const Rig& rig, double initial_bias_sigma);

  /// Integrates a batch to R_c1_c0 over `dt_s`. An empty (or degenerate) batch: the last rotation rate goes on.
  /// Returns whether gyro data was used.
  bool predict(const ImuBatch& imu, double dt_s);

  /// The predicted (after `correct`: corrected) rotation of the step.
  const Eigen::Quaterniond& R_c1_c0() const { return R_c1_c0_; }

  /// Where what frame 0 shows at `ray` is seen in frame 1 when the camera only turned [px]; far outside the image when
  /// the lens cannot see it.
  cv::Point2f turnedPixel(const Camera& camera, const Eigen::Vector3d& ray) const;

  /// How far the prediction may be off: information of its error rotation vector, camera frame c1 [1/rad^2].
  Eigen::Matrix3d information() const;

  /// The rotation as estimated from the points: R_true = Exp(delta) * R_predicted, with the information of delta
  /// (camera frame c1).
  void correct(const Eigen::Vector3d& delta, const Eigen::Matrix3d& information);

  /// How many times as long this step is as the one before: by how much motion that goes on is more; 1 where images are
  /// about as far apart as before, as stamps may be off.
  float stepRatio() const { return step_ratio_; }

  /// Estimated gyroscope bias, body frame [rad/s].
  const Eigen::Vector3d& bias() const { return bias_; }

 private:
  using Sensitivity = Eigen::Matrix<double, 3, 4>;

  /// By how much the prediction turns when bias and delay become larger (camera frame c1).
  Sensitivity sensitivity() const;

  Eigen::Quaterniond R_b_c_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  double delay_s_ = 0;                                       ///< of images
  Eigen::Matrix4d prior_, information_;                      ///< of bias and delay
  Eigen::Vector3d rate_change_b_ = Eigen::Vector3d::Zero();  ///< over the step, in the body's frame at its end [rad/s]
  Eigen::Quaterniond R_c1_c0_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_c_ = Eigen::Vector3d::Zero();  ///< rotation vector of R_c1_c0 per second
  double dt_s_ = 0;
  float step_ratio_ = 1;
  bool from_gyro_ = false;
};

}  // namespace lintel
