// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "CalibrationForms.h"
#include "ExactText.h"
#include "lintel/geometry/LensNames.h"
#include "lintel/sensing/Calibration.h"
#include "lintel/sensing/Recording.h"

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

std::string list(const std::vector<double>& values) {
  return list(Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
}

[[noreturn]] void refuseLens(const Camera& camera, const char* form) {
  throw RecordingError(std::string(form) + " has no place for the lens model " + lensName(camera.model).name +
                       (camera.model == LensModel::kRadialTangential ? " with k3" : "") + ": choose another form");
}

/// Model, intrinsics and distortion.
std::string kalibrCamera(const Camera& c) {
  std::vector<double> intrinsics{c.fx, c.fy, c.cx, c.cy}, lens = lensCoefficients(c);
  std::string model = "pinhole", distortion = c.wide() ? "equidistant" : "radtan";
  if (c.model >= LensModel::kDoubleSphere) {  // a model of its own: its coefficients come first
    model = c.model == LensModel::kDoubleSphere ? "ds" : "eucm";
    distortion = "none";
    intrinsics.insert(intrinsics.begin(), lens.begin(), lens.end());
    lens.clear();
  } else if (lens.size() != 4) {
    refuseLens(c, "Kalibr's form");
  }
  return "  camera_model: " + model + "\n  distortion_model: " + distortion + "\n  intrinsics: " + list(intrinsics) +
         "\n  distortion_coeffs: " + list(lens) + "\n";
}

/// The same; coefficients and focal lengths of equidistant cameras have names of their own.
std::string vinsCamera(const Camera& c) {
  const std::vector<double> k = lensCoefficients(c);
  if (c.model >= LensModel::kDoubleSphere || k.size() != 4) refuseLens(c, "VINS' form");
  const auto numbers = [&](const char* head, const std::vector<std::pair<const char*, double>>& values) {
    std::string text = std::string(head) + ":\n";
    for (const auto& [key, value] : values) text += std::string("  ") + key + ": " + exactText(value) + "\n";
    return text;
  };
  if (c.wide())
    return numbers("projection_parameters", {{"k2", k[0]},
                                             {"k3", k[1]},
                                             {"k4", k[2]},
                                             {"k5", k[3]},
                                             {"mu", c.fx},
                                             {"mv", c.fy},
                                             {"u0", c.cx},
                                             {"v0", c.cy}});
  return numbers("distortion_parameters", {{"k1", k[0]}, {"k2", k[1]}, {"p1", k[2]}, {"p2", k[3]}}) +
         numbers("projection_parameters", {{"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}});
}

std::string kalibrForm(const Rig& rig, double time_shift_s) {
  const Camera& c = rig.camera;
  const Eigen::Matrix4d T_b_c = matrixOf(rig.T_b_c);
  std::string text = "cam0:\n  T_imu_cam:\n";
  for (Eigen::Index i = 0; i < 4; ++i) text += "  - [" + row(T_b_c, i) + "]\n";
  text += "  T_cam_imu:\n";
  const Eigen::Matrix4d T_c_b = matrixOf(rig.T_b_c.inverse());
  for (Eigen::Index i = 0; i < 4; ++i) text += "  - [" + row(T_c_b, i) + "]\n";
  text += kalibrCamera(c);
  text += "  resolution: [" + std::to_string(c.width) + ", " + std::to_string(c.height) + "]\n";
  text += "  rate_hz: " + exactText(rig.camera_rate_hz) + "\n";
  text += "  timeshift_cam_imu: " + exactText(time_shift_s) + "\n";
  if (rig.line_delay_s != 0) text += "  line_delay_s: " + exactText(rig.line_delay_s) + "\n";
  text += "imu0:\n  update_rate: " + exactText(rig.imu_rate_hz);
  text += "\n  gyroscope_noise_density: " + exactText(rig.imu_noise.gyro_noise);
  text += "\n  gyroscope_random_walk: " + exactText(rig.imu_noise.gyro_walk);
  text += "\n  accelerometer_noise_density: " + exactText(rig.imu_noise.accel_noise);
  text += "\n  accelerometer_random_walk: " + exactText(rig.imu_noise.accel_walk) + "\n";
  return text + axesLines(rig.axes, "  ");
}

std::string matrixOfOpenCv(const std::string& key, const Eigen::MatrixXd& matrix) {
  return key + ": !!opencv-matrix\n  rows: " + std::to_string(matrix.rows()) +
         "\n  cols: " + std::to_string(matrix.cols()) + "\n  dt: d\n  data: " + list(matrix) + "\n";
}

std::string vinsForm(const Rig& rig, double time_shift_s) {
  const Camera& c = rig.camera;
  const double from_density = std::sqrt(200.0);  // VINS takes discrete noise; see readVinsForm
  std::string text =
      std::string("%YAML:1.0\n---\nmodel_type: ") + (c.wide() ? "KANNALA_BRANDT" : "PINHOLE") + "\ncamera_name: cam0\n";
  text += "image_width: " + std::to_string(c.width) + "\nimage_height: " + std::to_string(c.height) + "\n";
  text += vinsCamera(c);
  if (rig.line_delay_s != 0) text += "line_delay_s: " + exactText(rig.line_delay_s) + "\n";
  text += matrixOfOpenCv("extrinsicRotation", rig.T_b_c.q.toRotationMatrix());
  text += matrixOfOpenCv("extrinsicTranslation", rig.T_b_c.p);
  text += "acc_n: " + exactText(rig.imu_noise.accel_noise * from_density) +
          "\ngyr_n: " + exactText(rig.imu_noise.gyro_noise * from_density) +
          "\nacc_w: " + exactText(rig.imu_noise.accel_walk) + "\ngyr_w: " + exactText(rig.imu_noise.gyro_walk) + "\n" +
          axesLines(rig.axes);
  return text + "td: " + exactText(time_shift_s) + "\n";
}

}  // namespace

std::string writeCalibration(const Rig& rig, double time_shift_s, const std::string& form) {
  if (form == "kalibr") return kalibrForm(rig, time_shift_s);
  if (form == "vins") return vinsForm(rig, time_shift_s);
  throw std::invalid_argument(form + ": no form of a calibration");
}

}  // namespace lintel
