// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lintel/sensing/Recording.h"

namespace lintel {

/// One sensor's data in a recording.
struct RecordedSensor {
  std::string label;  ///< folder, sensor label or topic, as --camera and --imu take it
  std::string kind;   ///< sensor_msgs/Imu, CObservationImage, images, …
  std::size_t count = 0;
  double rate_hz = 0;  ///< mean; 0 if unknown
};

/// Everything that a recording holds, by label. Reads folders and rawlogs to their ends (or to where they are damaged).
/// `params` name the tables of a film or a folder of images. Throws RecordingError.
std::vector<RecordedSensor> recordedSensors(const std::string& path, const RecordingParams& params = {});

}  // namespace lintel
