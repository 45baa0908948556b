// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "GivenCalibration.h"
#include "lintel/sensing/Recording.h"

namespace mrpt::obs {
class CObservationIMU;
}

namespace lintel {

/// What the beginning of a rawlog shows of the whole.
struct RawlogProbe {
  Rig rig;
  std::string camera_label, imu_label;
  std::string first_external_image;  ///< empty when images are embedded
  std::vector<Warning> warnings;
};

/// Reads until one second after the first image and the first IMU sample. Takes the camera and IMU that `params` name,
/// else the alphabetically first. Throws RecordingError.
RawlogProbe probeRawlog(const std::string& path, const RecordingParams& params, const GivenCalibration& given);

/// True when it measures rotation and acceleration about all three axes.
bool isComplete(const mrpt::obs::CObservationIMU& observation);

}  // namespace lintel
