// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/core/Rig.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

/// The rig that a recording would be processed with, and what looks wrong with it.
struct RigReport {
  Rig rig;
  double time_shift_s = 0;            ///< of the calibration files; stamp on the IMU's clock = the image's + this
  std::vector<std::string> warnings;  ///< one line each
};

/// Of `recording` with the calibration that `params` name; without a recording (empty) that of the files alone. A look
/// at the first samples of the IMU shows a camera whose pose is given the wrong way round, and an accelerometer in g.
/// Throws RecordingError.
RigReport reportRig(const std::string& recording, const RecordingParams& params);

/// What the mean specific force of some seconds [m/s^2, body] says against a rig: the accelerometer's unit, and whether
/// the inverse of the camera's pose would have the camera upright where it lies on its head or side now.
std::vector<std::string> mountingDoubts(const Rig& rig, const Eigen::Vector3d& mean_accel);

}  // namespace lintel
