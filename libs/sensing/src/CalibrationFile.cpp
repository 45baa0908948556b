// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>

#include "CalibrationForms.h"
#include "CanonicalPose.h"

namespace lintel {
namespace {

/// Reads one file after the other into a Calibration.
class CalibrationReader {
 public:
  void read(const std::string& path);
  Calibration take() { return std::move(calibration_); }

 private:
  void readOpenVins(const YamlFile& file);
  void readChain(const YamlFile& file);
  void readChainCamera(const YamlFile& file, const std::string& label);
  void readImu(const YamlFile& file);
  void readSensorCamera(const YamlFile& file);
  void nameForm(const char* form) {
    if (calibration_.form.empty()) calibration_.form = form;
  }

  Calibration calibration_;
};

/// The keys that Kalibr and EuRoC have in common, and the coefficients under theirs.
CameraDescription describe(const YamlFile& file, const char* coefficients_key) {
  CameraDescription d;
  d.projection = file.get<std::string>("camera_model");
  d.distortion = file.get<std::string>("distortion_model");
  d.intrinsics = file.numbers("intrinsics");
  if (d.distortion != "none") d.coefficients = file.numbers(coefficients_key);
  const std::vector<double> size = file.list("resolution", 2);
  d.width = size[0];
  d.height = size[1];
  d.coefficients_key = coefficients_key;
  return d;
}

bool hasChainCamera(const YamlFile& file) { return file.isMap("cam0") && file.below("cam0").has("intrinsics"); }

void CalibrationReader::read(const std::string& path) {
  const YamlFile file(path, "give the calibration file's name");
  if (file.has("relative_config_imucam")) return readOpenVins(file);
  if (hasChainCamera(file) || file.isMap("imu0")) return readChain(file);
  if (file.has("T_BS") && file.has("camera_model")) return readSensorCamera(file);
  if (file.has("gyroscope_noise_density")) {
    nameForm("Kalibr's imu.yaml");
    return readImu(file);
  }
  if (file.has("projection_parameters") || file.has("cam0_calib") || file.has("extrinsicRotation"))
    return readVinsForm(file, calibration_);
  if (file.has("camera_matrix") || file.has("Camera_Matrix")) return readOpenCvForm(file, calibration_);
  throw RecordingError(path + ": no calibration of a known form: give Kalibr's camchain-imucam.yaml or imu.yaml, " +
                       "OpenVINS', VINS', EuRoC's or OpenCV's YAML file");
}

void CalibrationReader::readOpenVins(const YamlFile& file) {
  nameForm("OpenVINS");
  for (const char* key : {"relative_config_imucam", "relative_config_imu"})
    if (file.has(key)) read(besideFile(file, key));
}

/// Kalibr's camchain-imucam.yaml, or one of OpenVINS; and imu0, which stands in the same file or one of its own.
void CalibrationReader::readChain(const YamlFile& file) {
  nameForm("Kalibr");
  for (const std::string& key : file.keys())
    if (key.rfind("cam", 0) == 0 && file.isMap(key)) readChainCamera(file.below(key), key);
  if (file.isMap("imu0")) readImu(file.below("imu0"));
}

void CalibrationReader::readChainCamera(const YamlFile& file, const std::string& label) {
  CameraCalibration camera =
      describedCamera(describe(file, "distortion_coeffs"), file.where("").substr(0, file.where("").size() - 1));
  camera.label = label;
  camera.topic = file.get<std::string>("rostopic", "");
  // Kalibr: T_cam_imu takes coordinates in the IMU to coordinates in the camera
  if (file.has("T_imu_cam")) {
    camera.T_b_c = calibratedPose(file.matrix4("T_imu_cam"), file.where("T_imu_cam"));
  } else if (file.has("T_cam_imu")) {
    const Pose T_c_b = calibratedPose(file.matrix4("T_cam_imu"), file.where("T_cam_imu"));
    camera.T_b_c = canonicalPose(T_c_b.inverse());
  }
  if (file.has("timeshift_cam_imu")) camera.time_shift_s = file.finite("timeshift_cam_imu");
  if (file.has("rate_hz")) camera.rate_hz = file.positive("rate_hz");
  camera.line_delay_s = lineDelay_s(file);
  // Kalibr: nanoseconds, and the stamp is that of the first row
  if (file.has("line_delay")) {
    camera.line_delay_s = checkedLineDelay_s(1e-9 * file.finite("line_delay"), file.where("line_delay"));
    camera.time_shift_s += 0.5 * (file.list("resolution", 2)[1] - 1) * *camera.line_delay_s;
  }
  addCamera(std::move(camera), calibration_);
}

void CalibrationReader::readImu(const YamlFile& file) {
  ImuNoise noise;
  noise.gyro_noise = file.positive("gyroscope_noise_density");
  noise.gyro_walk = file.positive("gyroscope_random_walk");
  noise.accel_noise = file.positive("accelerometer_noise_density");
  noise.accel_walk = file.positive("accelerometer_random_walk");
  calibration_.imu_noise = noise;
  calibration_.axes = axesErrors(file);
  for (const char* key : {"update_rate", "rate_hz"})
    if (file.has(key)) calibration_.imu_rate_hz = file.positive(key);
  calibration_.imu_topic = file.get<std::string>("rostopic", calibration_.imu_topic);
}

/// A sensor.yaml of EuRoC's form, whose T_BS is taken as the camera's pose on the IMU.
void CalibrationReader::readSensorCamera(const YamlFile& file) {
  nameForm("EuRoC");
  CameraCalibration camera = describedCamera(describe(file, "distortion_coefficients"), file.path());
  camera.T_b_c = calibratedPose(file.matrix4("T_BS"), file.where("T_BS"));
  if (file.has("rate_hz")) camera.rate_hz = file.positive("rate_hz");
  camera.line_delay_s = lineDelay_s(file);
  addCamera(std::move(camera), calibration_);
}

}  // namespace

CameraCalibration describedCamera(CameraDescription description, const std::string& where) {
  CameraCalibration camera;
  camera.make = [description = std::move(description), where] { return makeCamera(description, where); };
  return camera;
}

void addCamera(CameraCalibration camera, Calibration& calibration) {
  auto& all = calibration.cameras;
  const auto same = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.label == camera.label; });
  if (same == all.end())
    all.push_back(std::move(camera));
  else
    *same = std::move(camera);
}

std::string besideFile(const YamlFile& file, const std::string& key) {
  const std::filesystem::path name = file.get<std::string>(key);
  return (std::filesystem::path(file.path()).parent_path() / name).string();
}

Calibration readCalibration(const std::vector<std::string>& files) {
  CalibrationReader reader;
  for (const std::string& file : files) reader.read(file);
  return reader.take();
}

const CameraCalibration* chooseCamera(const Calibration& calibration, const std::string& label) {
  const auto& all = calibration.cameras;
  if (all.empty()) return nullptr;
  if (label.empty()) return &all.front();
  std::string names;
  for (const CameraCalibration& camera : all) {
    if (camera.label == label || camera.topic == label) return &camera;
    names += (names.empty() ? "" : ", ") + camera.label;
  }
  if (all.size() == 1) return &all.front();
  throw RecordingError("the calibration has no camera '" + label + "': name one of " + names);
}

}  // namespace lintel
