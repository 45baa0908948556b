// SPDX-License-Identifier: BSD-3-Clause
#include "RecordingOptions.h"

namespace lintel {

void addRecordingOptions(CommandLine& line, RecordingParams& params) {
  line.option("--calibration", params.calibration,
              "Calibration instead of the recording's own: of Kalibr, OpenVINS, VINS, EuRoC or OpenCV")
      .type("FILE.yaml")
      .repeatable();
  line.option("--camera", params.camera,
              "Camera to use: its label or folder; cam0 or the alphabetically first by default")
      .type("LABEL");
  line.option("--imu", params.imu, "IMU to use: its label or folder; imu0 or the alphabetically first by default")
      .type("LABEL");
}

}  // namespace lintel
