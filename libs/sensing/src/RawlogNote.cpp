// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogNote.h"

#include <yaml-cpp/yaml.h>

#include <cmath>

#include "CalibrationForms.h"
#include "ExactText.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

constexpr const char* kTitle = "# Lintel recording: what MRPT observations have no fields for\n";

double positive(const YAML::Node& node, const std::string& key, const std::string& where) {
  const double value = node[key] ? node[key].as<double>() : 0.0;
  if (!std::isfinite(value) || value <= 0)
    throw RecordingError(where + ": " + key + " of the note must be greater than 0");
  return value;
}

RawlogNote fromYaml(const YAML::Node& root, const std::string& where) {
  RawlogNote note;
  const YAML::Node imu = root["imu"];
  note.imu_rate_hz = positive(imu, "rate_hz", where);
  note.imu_noise.gyro_noise = positive(imu, "gyroscope_noise_density", where);
  note.imu_noise.gyro_walk = positive(imu, "gyroscope_random_walk", where);
  note.imu_noise.accel_noise = positive(imu, "accelerometer_noise_density", where);
  note.imu_noise.accel_walk = positive(imu, "accelerometer_random_walk", where);
  const auto readAxes = [&](const std::string& key, Eigen::Matrix3d& axes) {
    if (const YAML::Node values = imu[key])
      axes = checkedAxes(values.as<std::vector<double>>(), where + ": " + key + " of the note");
  };
  readAxes("accelerometer_axes", note.axes.A);
  readAxes("gyroscope_axes", note.axes.G);
  for (const auto& camera : root["cameras"]) {
    const auto label = camera.first.as<std::string>();
    note.camera_rates_hz[label] = positive(camera.second, "rate_hz", where);
    if (const YAML::Node delay = camera.second["line_delay_s"])
      note.line_delays_s[label] = checkedLineDelay_s(delay.as<double>(), where + ": line_delay_s of the note");
  }
  return note;
}

std::string lineDelayText(const RawlogNote& note, const std::string& label) {
  const auto delay = note.line_delays_s.find(label);
  return delay == note.line_delays_s.end() ? "" : ", line_delay_s: " + exactText(delay->second);
}

}  // namespace

std::string formatNote(const RawlogNote& note) {
  std::string text = kTitle;
  text += "imu:\n  rate_hz: " + exactText(note.imu_rate_hz);
  text += "\n  gyroscope_noise_density: " + exactText(note.imu_noise.gyro_noise) + "  # rad/s/sqrt(Hz)";
  text += "\n  gyroscope_random_walk: " + exactText(note.imu_noise.gyro_walk) + "  # rad/s^2/sqrt(Hz)";
  text += "\n  accelerometer_noise_density: " + exactText(note.imu_noise.accel_noise) + "  # m/s^2/sqrt(Hz)";
  text += "\n  accelerometer_random_walk: " + exactText(note.imu_noise.accel_walk) + "  # m/s^3/sqrt(Hz)\n";
  text += axesLines(note.axes, "  ") + "cameras:\n";
  for (const auto& [label, rate_hz] : note.camera_rates_hz)
    text += "  " + label + ": {rate_hz: " + exactText(rate_hz) + lineDelayText(note, label) + "}\n";
  return text;
}

std::optional<RawlogNote> parseNote(const std::string& text, const std::string& where) {
  if (text.rfind(kTitle, 0) != 0) return std::nullopt;
  try {
    return fromYaml(YAML::Load(text), where);
  } catch (const YAML::Exception& e) {
    throw RecordingError(where + ": damaged note: line " + std::to_string(e.mark.line + 1) + ": " + e.msg);
  }
}

}  // namespace lintel
