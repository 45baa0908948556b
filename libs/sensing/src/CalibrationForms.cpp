// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "CalibrationForms.h"
#include "CanonicalPose.h"
#include "ExactText.h"

namespace lintel {
namespace {

constexpr double kVinsRate_hz = 200;  ///< VINS' files do not say it

/// VINS adds its standard deviations to single samples, as discrete noise: a density is that by the root of the rate.
/// Those of the biases are multiplied by the time step there, and are taken as densities.
ImuNoise vinsNoise(const YamlFile& file) {
  const double to_density = 1 / std::sqrt(kVinsRate_hz);
  ImuNoise noise;
  noise.accel_noise = file.positive("acc_n") * to_density;
  noise.gyro_noise = file.positive("gyr_n") * to_density;
  noise.accel_walk = file.positive("acc_w");
  noise.gyro_walk = file.positive("gyr_w");
  return noise;
}

CameraDescription descriptionOf(const YamlFile& file) {
  CameraDescription d;
  const auto model = file.get<std::string>("model_type");
  d.width = file.get<double>("image_width");
  d.height = file.get<double>("image_height");
  d.projection_key = "model_type";
  d.distortion_key = "model_type";
  d.coefficients_key = "distortion_parameters";
  d.size_key = "image_width, image_height";
  if (model == "KANNALA_BRANDT") {
    const YamlFile p = file.below("projection_parameters");
    for (const char* key : {"mu", "mv", "u0", "v0"}) d.intrinsics.push_back(p.finite(key));
    for (const char* key : {"k2", "k3", "k4", "k5"}) d.coefficients.push_back(p.finite(key));
    d.distortion = "equidistant";
    return d;
  }
  d.projection = model;
  if (model != "PINHOLE") return d;  // refused by its name
  const YamlFile p = file.below("projection_parameters"), k = file.below("distortion_parameters");
  for (const char* key : {"fx", "fy", "cx", "cy"}) d.intrinsics.push_back(p.finite(key));
  for (const char* key : {"k1", "k2", "p1", "p2"}) d.coefficients.push_back(k.finite(key));
  d.distortion = "radtan";
  return d;
}

/// `number`: of the camera in VINS-Fusion's file; empty for VINS-Mono's.
CameraCalibration vinsCamera(const YamlFile& main, const std::string& number) {
  const YamlFile file = number.empty() ? main : YamlFile(besideFile(main, "cam" + number + "_calib"), "put it there");
  CameraCalibration camera = describedCamera(descriptionOf(file), file.path());
  camera.label = "cam" + (number.empty() ? "0" : number);
  camera.topic = main.get<std::string>(number.empty() ? "image_topic" : "image" + number + "_topic", "");
  const std::string pose = "body_T_cam" + (number.empty() ? "0" : number);
  // both take coordinates in the camera to coordinates in the IMU
  if (main.has(pose)) {
    camera.T_b_c = calibratedPose(main.matrix4(pose), main.where(pose));
  } else if (main.has("extrinsicRotation")) {
    Eigen::Matrix4d T_b_c = Eigen::Matrix4d::Identity();
    T_b_c.topLeftCorner<3, 3>() = main.matrix3("extrinsicRotation");
    T_b_c.topRightCorner<3, 1>() = Eigen::Vector3d(main.list("extrinsicTranslation", 3).data());
    camera.T_b_c = calibratedPose(T_b_c, main.where("extrinsicRotation"));
  }
  if (main.has("td")) camera.time_shift_s = main.finite("td");
  camera.line_delay_s = lineDelay_s(main);
  // VINS: the time of a whole image; its stamp is that of the middle row there, too
  if (main.get<int>("rolling_shutter", 0) != 0 && main.has("rolling_shutter_tr"))
    camera.line_delay_s = checkedLineDelay_s(main.finite("rolling_shutter_tr") / file.get<double>("image_height"),
                                             main.where("rolling_shutter_tr"));
  return camera;
}

}  // namespace

void readVinsForm(const YamlFile& file, Calibration& calibration) {
  if (calibration.form.empty()) calibration.form = "VINS";
  if (file.has("acc_n")) calibration.imu_noise = vinsNoise(file);
  if (file.has("acc_n")) calibration.axes = axesErrors(file);
  calibration.imu_topic = file.get<std::string>("imu_topic", calibration.imu_topic);
  if (file.has("projection_parameters")) addCamera(vinsCamera(file, ""), calibration);
  for (int i = 0; file.has("cam" + std::to_string(i) + "_calib"); ++i)
    addCamera(vinsCamera(file, std::to_string(i)), calibration);
}

void readOpenCvForm(const YamlFile& file, Calibration& calibration) {
  if (calibration.form.empty()) calibration.form = "OpenCV";
  const std::string matrix = file.has("camera_matrix") ? "camera_matrix" : "Camera_Matrix";
  const std::string coefficients =
      file.has("distortion_coefficients") ? "distortion_coefficients" : "Distortion_Coefficients";
  const Eigen::Matrix3d K = file.matrix3(matrix);
  CameraDescription d;
  d.intrinsics = {K(0, 0), K(1, 1), K(0, 2), K(1, 2)};
  d.intrinsics_key = matrix;
  d.coefficients_key = coefficients;
  d.size_key = "image_width, image_height";
  d.width = file.get<double>(file.has("image_width") ? "image_width" : "image_Width");
  d.height = file.get<double>(file.has("image_height") ? "image_height" : "image_Height");
  d.distortion = file.get<std::string>("distortion_model", "plumb_bob");
  d.coefficients = file.numbers(coefficients);
  CameraCalibration camera = describedCamera(std::move(d), file.path());
  if (file.has("T_imu_cam")) camera.T_b_c = calibratedPose(file.matrix4("T_imu_cam"), file.where("T_imu_cam"));
  camera.line_delay_s = lineDelay_s(file);
  addCamera(std::move(camera), calibration);
}

std::optional<double> lineDelay_s(const YamlFile& file) {
  if (!file.has("line_delay_s")) return std::nullopt;
  return checkedLineDelay_s(file.finite("line_delay_s"), file.where("line_delay_s"));
}

std::optional<AxesErrors> axesErrors(const YamlFile& file) {
  const auto given = [&](const std::string& key) -> Eigen::Matrix3d {
    if (!file.has(key)) return Eigen::Matrix3d::Zero();
    return checkedAxes(file.numbers(key), file.where(key));
  };
  if (!file.has("accelerometer_axes") && !file.has("gyroscope_axes")) return std::nullopt;
  return AxesErrors{given("accelerometer_axes"), given("gyroscope_axes")};
}

Eigen::Matrix3d checkedAxes(const std::vector<double>& values, const std::string& where) {
  constexpr double kMost = 0.3;  // 17 degrees, or a third of a scale: beyond it the unit or the mounting is wrong
  if (values.size() != 9) throw RecordingError(where + " needs 9 values, row by row");
  for (const double value : values)
    if (!(std::abs(value) <= kMost))
      throw RecordingError(where + " must be errors of scales and directions, each at most 0.3, zero for right axes");
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

std::string axesLines(const AxesErrors& axes, const std::string& indentation) {
  const auto line = [&](const char* key, const Eigen::Matrix3d& errors) {
    if (errors.isZero(0)) return std::string();
    std::string values;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        values += (values.empty() ? "[" : ", ") + exactText(errors(row, column));
    return indentation + key + ": " + values + "]\n";
  };
  return line("accelerometer_axes", axes.A) + line("gyroscope_axes", axes.G);
}

double checkedLineDelay_s(double line_delay_s, const std::string& where) {
  constexpr double kLongest_s = 1e-3;  // a thousand rows would take a second
  if (std::abs(line_delay_s) > kLongest_s)
    throw RecordingError(where +
                         " is more than a millisecond from row to row: check its unit (line_delay_s: seconds; " +
                         "Kalibr's line_delay: nanoseconds)");
  return line_delay_s;
}

}  // namespace lintel
