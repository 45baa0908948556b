// SPDX-License-Identifier: BSD-3-Clause
#include "EurocYaml.h"

#include <vector>

#include "CalibrationForms.h"
#include "CameraModel.h"
#include "CanonicalPose.h"
#include "YamlFile.h"

namespace lintel {
namespace {

YamlFile sensorFile(const std::string& path) { return {path, "every sensor folder needs its sensor.yaml"}; }

}  // namespace

EurocCamera loadEurocCamera(const std::string& path) {
  const YamlFile file = sensorFile(path);
  CameraDescription description;
  description.projection = file.get<std::string>("camera_model");
  const std::vector<double> size = file.list("resolution", 2);
  description.width = size[0];
  description.height = size[1];
  description.intrinsics = file.numbers("intrinsics");
  if (description.projection == "pinhole") description.distortion = file.get<std::string>("distortion_model");
  if (description.distortion != "none") description.coefficients = file.numbers("distortion_coefficients");
  EurocCamera camera;
  camera.model = makeCamera(description, path);
  camera.T_v_c = calibratedPose(file.matrix4("T_BS"), file.where("T_BS"));
  camera.rate_hz = file.positive("rate_hz");
  camera.line_delay_s = lineDelay_s(file).value_or(0);
  return camera;
}

EurocImu loadEurocImu(const std::string& path) {
  const YamlFile file = sensorFile(path);
  EurocImu imu;
  imu.T_v_b = calibratedPose(file.matrix4("T_BS"), file.where("T_BS"));
  imu.rate_hz = file.positive("rate_hz");
  imu.noise.gyro_noise = file.positive("gyroscope_noise_density");
  imu.noise.gyro_walk = file.positive("gyroscope_random_walk");
  imu.noise.accel_noise = file.positive("accelerometer_noise_density");
  imu.noise.accel_walk = file.positive("accelerometer_random_walk");
  imu.axes = axesErrors(file).value_or(AxesErrors());
  return imu;
}

Rig rigOf(const EurocCamera& camera, const EurocImu& imu) {
  Rig rig;
  rig.camera = camera.model;
  rig.T_b_c = imu.T_v_b.inverse() * camera.T_v_c;
  rig.camera_rate_hz = camera.rate_hz;
  rig.line_delay_s = camera.line_delay_s;
  rig.imu_noise = imu.noise;
  rig.axes = imu.axes;
  rig.imu_rate_hz = imu.rate_hz;
  return rig;
}

}  // namespace lintel
