// SPDX-License-Identifier: BSD-3-Clause
#include "GyroPrediction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kForget =
    0.98;  ///< of the information, per frame: the bias walks, so that the weight of early errors must decay
constexpr double kRotationNoise_rad = 5e-4;  ///< of an integrated step: gyro noise, timing, exposure
constexpr double kUnknownRate = 1.0;         ///< [rad/s] how far constant rotation may be wrong without gyro
constexpr double kMinBiasSigma = 1e-3;       ///< [rad/s] lower bound of the bias's standard deviation
constexpr double kAsLong = 1.5;              ///< of the step before: between one image and two
constexpr double kDelaySigma_s = 0.01;  ///< before anything has turned: most stamps are right, others up to 0.1 s off
constexpr double kLongestDelay_s = 0.1;
constexpr std::int64_t kRateOver_ns = 15'000'000;  ///< rates at the ends of a step: longer than a vibration

/// Mean rate of the samples nearest to the batch's beginning or end.
Eigen::Vector3d meanRate(const ImuBatch& imu, bool at_end) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int n = 0;
  for (const ImuSample& sample : imu) {
    const std::int64_t away_ns = at_end ? imu.back().t_ns - sample.t_ns : sample.t_ns - imu.front().t_ns;
    if (away_ns <= kRateOver_ns) sum += sample.gyro, ++n;
  }
  return sum / n;
}

}  // namespace

GyroPrediction::GyroPrediction(const Rig& rig, double initial_bias_sigma) : R_b_c_(rig.T_b_c.q) {
  prior_ = Eigen::Matrix4d::Identity() / (initial_bias_sigma * initial_bias_sigma);
  prior_(3, 3) = 1 / (kDelaySigma_s * kDelaySigma_s);
  information_ = prior_;
}

bool GyroPrediction::predict(const ImuBatch& imu, double dt_s) {
  const double ratio = dt_s_ > 0 ? dt_s / dt_s_ : 1.0;
  step_ratio_ = std::abs(std::log(ratio)) > std::log(kAsLong) ? static_cast<float>(ratio) : 1.0f;
  dt_s_ = dt_s;
  Eigen::Quaterniond R_b0_b1 = Eigen::Quaterniond::Identity();
  double covered_s = 0;
  for (std::size_t i = 1; i < imu.size(); ++i) {
    const double step_s = 1e-9 * static_cast<double>(imu[i].t_ns - imu[i - 1].t_ns);
    if (!(step_s > 0)) continue;
    R_b0_b1 = R_b0_b1 * expRotation((0.5 * (imu[i].gyro + imu[i - 1].gyro) - bias_) * step_s);
    covered_s += step_s;
  }
  from_gyro_ = covered_s > 0.9 * dt_s && covered_s < 1.1 * dt_s;
  if (from_gyro_) {
    const Eigen::Vector3d before = meanRate(imu, false) - bias_, after = meanRate(imu, true) - bias_;
    rate_change_b_ = after - R_b0_b1.conjugate() * before;
    R_b0_b1 = expRotation(-delay_s_ * before) * R_b0_b1 * expRotation(delay_s_ * after);
  }
  R_c1_c0_ =
      from_gyro_ ? (R_b_c_.conjugate() * R_b0_b1.conjugate() * R_b_c_).normalized() : expRotation(rate_c_ * dt_s);
  rate_c_ = logRotation(R_c1_c0_) / dt_s;
  return from_gyro_;
}

cv::Point2f GyroPrediction::turnedPixel(const Camera& camera, const Eigen::Vector3d& ray) const {
  const Eigen::Vector3d f1 = R_c1_c0_ * ray;
  if (camera.wide() ? !camera.projects(f1) : f1.z() < 0.1) return {-1e4f, -1e4f};
  const Eigen::Vector2d px = camera.project(f1);
  return {static_cast<float>(px.x()), static_cast<float>(px.y())};
}

/// R_c1_c0 = R_c_b Exp(-after delay) R_b1_b0 Exp(before delay) R_b_c, and R_b1_b0 = Exp(-(gyro - bias) dt): a bias
/// larger by db turns the prediction by Exp(R_c_b db dt), a delay larger by d by Exp(-R_c_b rate_change d).
GyroPrediction::Sensitivity GyroPrediction::sensitivity() const {
  const Eigen::Matrix3d R_c_b = R_b_c_.toRotationMatrix().transpose();
  Sensitivity J;
  J << dt_s_ * R_c_b, -R_c_b * rate_change_b_;
  return J;
}

Eigen::Matrix3d GyroPrediction::information() const {
  const Eigen::Matrix3d noise = kRotationNoise_rad * kRotationNoise_rad * Eigen::Matrix3d::Identity();
  if (!from_gyro_) return (noise + dt_s_ * dt_s_ * kUnknownRate * kUnknownRate * Eigen::Matrix3d::Identity()).inverse();
  const Sensitivity J = sensitivity();
  return (noise + J * information_.inverse() * J.transpose()).inverse();
}

void GyroPrediction::correct(const Eigen::Vector3d& delta, const Eigen::Matrix3d& information) {
  R_c1_c0_ = (expRotation(delta) * R_c1_c0_).normalized();
  rate_c_ = logRotation(R_c1_c0_) / dt_s_;
  if (!from_gyro_) return;
  const Eigen::Matrix3d seen =
      (information.inverse() + kRotationNoise_rad * kRotationNoise_rad * Eigen::Matrix3d::Identity()).inverse();
  const Sensitivity J = sensitivity();
  // what images said is forgotten, the prior is not
  information_ = kForget * information_ + (1 - kForget) * prior_ + J.transpose() * seen * J;
  const Eigen::Vector4d change = information_.inverse() * (J.transpose() * (seen * delta));
  bias_ += change.head<3>();
  delay_s_ = std::clamp(delay_s_ + change(3), -kLongestDelay_s, kLongestDelay_s);
  const double strongest = 1.0 / (kMinBiasSigma * kMinBiasSigma);
  const double trace = information_.topLeftCorner<3, 3>().trace() / 3;
  if (trace > strongest) information_ *= strongest / trace;
}

}  // namespace lintel
