// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <stdexcept>

#include "ExactText.h"
#include "lintel/sensing/Calibration.h"

namespace lintel {
namespace {

/// Rows of a matrix, as YAML writes a list.
std::string row(const Eigen::MatrixXd& matrix, Eigen::Index i) {
  std::string text;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) text += (j > 0 ? ", " : "") + exactText(matrix(i, j));
  return text;
}

std::string list(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) text += (i > 0 ? ", " : "") + row(matrix, i);
  return "[" + text + "]";
}

Eigen::Matrix4d matrixOf(const Pose& pose) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = pose.q.toRotationMatrix();
  T.topRightCorner<3, 1>() = pose.p;
  return T;
}

std::string kalibrForm(const Rig& rig, double time_shift_s) {
  const PinholeRadtan& c = rig.camera;
  const Eigen::Matrix4d T_b_c = matrixOf(rig.T_b_c);
  std::string text = "cam0:\n  T_imu_cam:\n";
  for (Eigen::Index i = 0; i < 4; ++i) text += "  - [" + row(T_b_c, i) + "]\n";
  text += "  T_cam_imu:\n";
  const Eigen::Matrix4d T_c_b = matrixOf(rig.T_b_c.inverse());
  for (Eigen::Index i = 0; i < 4; ++i) text += "  - [" + row(T_c_b, i) + "]\n";
  text += "  camera_model: pinhole\n  distortion_model: radtan\n";
  text += "  intrinsics: " + list(Eigen::RowVector4d(c.fx, c.fy, c.cx, c.cy)) + "\n";
  text += "  distortion_coeffs: " + list(Eigen::RowVector4d(c.k1, c.k2, c.p1, c.p2)) + "\n";
  text += "  resolution: [" + std::to_string(c.width) + ", " + std::to_string(c.height) + "]\n";
  text += "  rate_hz: " + exactText(rig.camera_rate_hz) + "\n";
  text += "  timeshift_cam_imu: " + exactText(time_shift_s) + "\n";
  text += "imu0:\n  update_rate: " + exactText(rig.imu_rate_hz);
  text += "\n  gyroscope_noise_density: " + exactText(rig.imu_noise.gyro_noise);
  text += "\n  gyroscope_random_walk: " + exactText(rig.imu_noise.gyro_walk);
  text += "\n  accelerometer_noise_density: " + exactText(rig.imu_noise.accel_noise);
  return text + "\n  accelerometer_random_walk: " + exactText(rig.imu_noise.accel_walk) + "\n";
}

std::string matrixOfOpenCv(const std::string& key, const Eigen::MatrixXd& matrix) {
  return key + ": !!opencv-matrix\n  rows: " + std::to_string(matrix.rows()) +
         "\n  cols: " + std::to_string(matrix.cols()) + "\n  dt: d\n  data: " + list(matrix) + "\n";
}

std::string vinsForm(const Rig& rig, double time_shift_s) {
  const PinholeRadtan& c = rig.camera;
  const double from_density = std::sqrt(200.0);  // VINS takes discrete noise; see readVinsForm
  std::string text = "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: cam0\n";
  text += "image_width: " + std::to_string(c.width) + "\nimage_height: " + std::to_string(c.height) + "\n";
  text += "distortion_parameters:\n  k1: " + exactText(c.k1) + "\n  k2: " + exactText(c.k2) +
          "\n  p1: " + exactText(c.p1) + "\n  p2: " + exactText(c.p2) + "\n";
  text += "projection_parameters:\n  fx: " + exactText(c.fx) + "\n  fy: " + exactText(c.fy) +
          "\n  cx: " + exactText(c.cx) + "\n  cy: " + exactText(c.cy) + "\n";
  text += matrixOfOpenCv("extrinsicRotation", rig.T_b_c.q.toRotationMatrix());
  text += matrixOfOpenCv("extrinsicTranslation", rig.T_b_c.p);
  text += "acc_n: " + exactText(rig.imu_noise.accel_noise * from_density) +
          "\ngyr_n: " + exactText(rig.imu_noise.gyro_noise * from_density) +
          "\nacc_w: " + exactText(rig.imu_noise.accel_walk) + "\ngyr_w: " + exactText(rig.imu_noise.gyro_walk) + "\n";
  return text + "td: " + exactText(time_shift_s) + "\n";
}

}  // namespace

std::string writeCalibration(const Rig& rig, double time_shift_s, const std::string& form) {
  if (form == "kalibr") return kalibrForm(rig, time_shift_s);
  if (form == "vins") return vinsForm(rig, time_shift_s);
  throw std::invalid_argument(form + ": no form of a calibration");
}

}  // namespace lintel
