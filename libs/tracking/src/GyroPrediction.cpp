// SPDX-License-Identifier: BSD-3-Clause
#include "GyroPrediction.h"

#include <Eigen/LU>
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

}  // namespace

GyroPrediction::GyroPrediction(const Rig& rig, double initial_bias_sigma)
    : R_b_c_(rig.T_b_c.q), bias_information_(Eigen::Matrix3d::Identity() / (initial_bias_sigma * initial_bias_sigma)) {}

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

Eigen::Matrix3d GyroPrediction::information() const {
  const Eigen::Matrix3d noise = kRotationNoise_rad * kRotationNoise_rad * Eigen::Matrix3d::Identity();
  const double dt2 = dt_s_ * dt_s_;
  if (!from_gyro_) return (noise + dt2 * kUnknownRate * kUnknownRate * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Matrix3d R_c_b = R_b_c_.toRotationMatrix().transpose();
  return (noise + dt2 * R_c_b * bias_information_.inverse() * R_c_b.transpose()).inverse();
}

void GyroPrediction::correct(const Eigen::Vector3d& delta, const Eigen::Matrix3d& information) {
  R_c1_c0_ = (expRotation(delta) * R_c1_c0_).normalized();
  rate_c_ = logRotation(R_c1_c0_) / dt_s_;
  if (!from_gyro_) return;
  // R_c1_c0 = R_c_b Exp(-(gyro - bias) dt) R_b_c: a bias larger by db turns the prediction by Exp(R_c_b db dt).
  const Eigen::Matrix3d R_b_c = R_b_c_.toRotationMatrix();
  const Eigen::Matrix3d seen =
      (information.inverse() + kRotationNoise_rad * kRotationNoise_rad * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Matrix3d measured = dt_s_ * dt_s_ * R_b_c * seen * R_b_c.transpose();
  bias_information_ = kForget * bias_information_ + measured;
  bias_ += bias_information_.inverse() * (measured * (R_b_c * delta / dt_s_));
  const double strongest = 1.0 / (kMinBiasSigma * kMinBiasSigma);
  const double trace = bias_information_.trace() / 3;
  if (trace > strongest) bias_information_ *= strongest / trace;
}

}  // namespace lintel
