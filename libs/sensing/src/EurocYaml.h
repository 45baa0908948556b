// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/Rig.h"

namespace lintel {

/// camN/sensor.yaml.
struct EurocCamera {
  Camera model;
  Pose T_v_c;  ///< T_BS: camera in the vehicle's frame, canonical
  double rate_hz = 0;
  double line_delay_s = 0;  ///< of a rolling shutter (Rig.h)
};

/// imu0/sensor.yaml.
struct EurocImu {
  ImuNoise noise;
  AxesErrors axes;
  Pose T_v_b;  ///< T_BS: IMU in the vehicle's frame (identity in EuRoC), canonical
  double rate_hz = 0;
};

/// Both throw RecordingError naming file and key when something is missing, not supported or makes no sense.
EurocCamera loadEurocCamera(const std::string& path);
EurocImu loadEurocImu(const std::string& path);

/// The rig of one camera and one IMU whose poses are given in the same vehicle frame.
Rig rigOf(const EurocCamera& camera, const EurocImu& imu);

}  // namespace lintel
