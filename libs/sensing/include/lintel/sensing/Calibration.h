// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lintel/core/Rig.h"

namespace lintel {

/// A camera of a calibration file.
struct CameraCalibration {
  std::string label;             ///< cam0, …; empty where the file has no name for it
  std::string topic;             ///< ROS topic; empty where the file names none
  std::function<Camera()> make;  ///< throws RecordingError when the model is not supported
  std::optional<Pose> T_b_c;     ///< canonical; absent in files of a camera alone
  double time_shift_s = 0;       ///< stamp on the IMU's clock = stamp of the image + this
  std::optional<double> rate_hz;
  std::optional<double> line_delay_s;  ///< of a rolling shutter (Rig.h)
};

/// What calibration files say.
struct Calibration {
  std::string form;  ///< of the first file, in words: "Kalibr", …
  std::vector<CameraCalibration> cameras;
  std::string imu_topic;
  std::optional<ImuNoise> imu_noise;
  std::optional<AxesErrors> axes;
  std::optional<double> imu_rate_hz;
};

/// Reads files of Kalibr (camchain-imucam.yaml, imu.yaml), OpenVINS (estimator_config.yaml or its two kalibr_*.yaml),
/// VINS (with the camera's file that it names), EuRoC (sensor.yaml of a camera or an IMU), and OpenCV or ROS (a camera
/// alone); what a later file says counts. Throws RecordingError naming file and key.
Calibration readCalibration(const std::vector<std::string>& files);

/// The camera labelled `label` or, in a bag, of this topic; the first when `label` is empty, and when there is but one.
/// Throws RecordingError naming those there are. Null when the calibration has none.
const CameraCalibration* chooseCamera(const Calibration& calibration, const std::string& label);

/// What looks wrong with a rig, one line each: units, noise densities beyond those of any sensor, a strange lens.
std::vector<std::string> rigDoubts(const Rig& rig, double time_shift_s = 0);

/// A rig in words, several lines: for a person who wants to know whether it is the one meant.
std::string rigInWords(const Rig& rig, double time_shift_s = 0);

/// A rig as a file that readCalibration() reads to the same values: Kalibr's camchain with the IMU's noise ("kalibr"),
/// or VINS' form ("vins").
std::string writeCalibration(const Rig& rig, double time_shift_s, const std::string& form);

}  // namespace lintel
