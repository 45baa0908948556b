// SPDX-License-Identifier: BSD-3-Clause
#include "EurocYaml.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "CanonicalPose.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

/// A sensor.yaml with typed access that names file and key on failure.
class SensorFile {
 public:
  explicit SensorFile(const std::string& path) : path_(path) {
    std::ifstream file(path);
    if (!file) throw RecordingError(path + ": missing: every sensor folder needs its sensor.yaml");
    // OpenCV writes "%YAML:1.0" as a first line, which is no YAML.
    std::ostringstream text;
    for (std::string line; std::getline(file, line);) text << (line.rfind('%', 0) == 0 ? "" : line) << '\n';
    try {
      root_ = YAML::Load(text.str());
    } catch (const YAML::Exception& e) {
      throw RecordingError(path + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML: " + e.msg);
    }
    if (!root_.IsMap()) throw RecordingError(path + ": empty or no YAML map: write the sensor's parameters into it");
  }

  std::string where(const std::string& key) const { return path_ + ": " + key; }

  template <class T>
  T get(const std::string& key) const {
    return as<T>(root_[key], key);
  }

  /// A finite number greater than 0.
  double positive(const std::string& key) const {
    const double value = get<double>(key);
    if (!std::isfinite(value) || value <= 0) throw RecordingError(where(key) + " must be a number greater than 0");
    return value;
  }

  std::vector<double> list(const std::string& key, std::size_t count) const {
    const auto values = get<std::vector<double>>(key);
    if (values.size() != count)
      throw RecordingError(where(key) + " has " + std::to_string(values.size()) + " values, expected " +
                           std::to_string(count));
    return values;
  }

  Eigen::Matrix4d pose(const std::string& key) const {
    const YAML::Node node = root_[key];
    const auto values = as<std::vector<double>>(node && node.IsMap() ? node["data"] : node, key + ": data");
    if (values.size() != 16) throw RecordingError(where(key) + " needs 16 values, row by row");
    return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  }

 private:
  template <class T>
  T as(const YAML::Node& node, const std::string& key) const {
    if (!node || node.IsNull()) throw RecordingError(where(key) + " is missing: add it");
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      throw RecordingError(path_ + ":" + std::to_string(node.Mark().line + 1) + ": " + key +
                           " is not of the expected type");
    }
  }

  std::string path_;
  YAML::Node root_;
};

void setDistortion(PinholeRadtan& camera, const SensorFile& file) {
  const auto model = file.get<std::string>("distortion_model");
  if (model == "none") return;
  if (model != "radial-tangential" && model != "radtan" && model != "plumb_bob")
    throw RecordingError(file.where("distortion_model") + " '" + model +
                         "' is not supported: use radial-tangential or none (undistorted images)");
  const std::vector<double> d = file.list("distortion_coefficients", 4);
  camera.k1 = d[0];
  camera.k2 = d[1];
  camera.p1 = d[2];
  camera.p2 = d[3];
}

}  // namespace

void checkCamera(const PinholeRadtan& camera, const std::string& where) {
  const double values[] = {camera.fx, camera.fy, camera.cx, camera.cy, camera.k1, camera.k2, camera.p1, camera.p2};
  for (const double value : values)
    if (!std::isfinite(value)) throw RecordingError(where + ": a camera parameter is not finite: calibrate the camera");
  if (camera.width <= 0 || camera.height <= 0) throw RecordingError(where + ": the image size must be greater than 0");
  if (camera.fx <= 0 || camera.fy <= 0)
    throw RecordingError(where + ": the focal lengths must be greater than 0: calibrate the camera");
}

EurocCamera loadEurocCamera(const std::string& path) {
  const SensorFile file(path);
  EurocCamera camera;
  const auto model = file.get<std::string>("camera_model");
  if (model != "pinhole")
    throw RecordingError(file.where("camera_model") + " '" + model + "' is not supported: use pinhole");
  const std::vector<double> size = file.list("resolution", 2), k = file.list("intrinsics", 4);
  for (const double pixels : size)
    if (!(pixels >= 1 && pixels <= 65536 && pixels == std::floor(pixels)))
      throw RecordingError(file.where("resolution") + " must be two whole numbers of pixels, width and height");
  camera.model.width = static_cast<int>(size[0]);
  camera.model.height = static_cast<int>(size[1]);
  camera.model.fx = k[0];
  camera.model.fy = k[1];
  camera.model.cx = k[2];
  camera.model.cy = k[3];
  setDistortion(camera.model, file);
  checkCamera(camera.model, path);
  camera.T_v_c = calibratedPose(file.pose("T_BS"), file.where("T_BS"));
  camera.rate_hz = file.positive("rate_hz");
  return camera;
}

EurocImu loadEurocImu(const std::string& path) {
  const SensorFile file(path);
  EurocImu imu;
  imu.T_v_b = calibratedPose(file.pose("T_BS"), file.where("T_BS"));
  imu.rate_hz = file.positive("rate_hz");
  imu.noise.gyro_noise = file.positive("gyroscope_noise_density");
  imu.noise.gyro_walk = file.positive("gyroscope_random_walk");
  imu.noise.accel_noise = file.positive("accelerometer_noise_density");
  imu.noise.accel_walk = file.positive("accelerometer_random_walk");
  return imu;
}

Rig rigOf(const EurocCamera& camera, const EurocImu& imu) {
  Rig rig;
  rig.camera = camera.model;
  rig.T_b_c = imu.T_v_b.inverse() * camera.T_v_c;
  rig.camera_rate_hz = camera.rate_hz;
  rig.imu_noise = imu.noise;
  rig.imu_rate_hz = imu.rate_hz;
  return rig;
}

}  // namespace lintel
