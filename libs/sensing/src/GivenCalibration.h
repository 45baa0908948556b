// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "Warnings.h"
#include "lintel/sensing/Calibration.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

/// The calibration that a recording is opened with: of files where they are given, else its own.
class GivenCalibration {
 public:
  /// Reads the files that `params` name and chooses the camera that they name. Throws RecordingError.
  explicit GivenCalibration(const RecordingParams& params);

  /// ROS topics that the files name; empty if none.
  const std::string& cameraTopic() const { return camera_topic_; }
  const std::string& imuTopic() const { return calibration_.imu_topic; }

  std::optional<double> cameraRate_hz() const { return camera_ ? camera_->rate_hz : std::nullopt; }
  std::optional<double> imuRate_hz() const { return calibration_.imu_rate_hz; }
  bool hasNoise() const { return calibration_.imu_noise.has_value(); }

  /// What the IMU's stamps are to be moved by, to be on the images' clock [ns], whole ticks.
  std::int64_t shift_ns() const { return shift_ns_; }

  /// The rig; `own` gives the recording's own (it may throw RecordingError), for what the files do not say.
  Rig rig(const std::function<Rig()>& own, std::vector<Warning>& warnings) const;

 private:
  Calibration calibration_;
  std::optional<CameraCalibration> camera_;
  std::string camera_topic_;
  std::int64_t shift_ns_ = 0;
};

}  // namespace lintel
