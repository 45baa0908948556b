// SPDX-License-Identifier: BSD-3-Clause
#include "RecordingOptions.h"

namespace lintel {

void addRecordingOptions(CommandLine& line, RecordingParams& params) {
  line.option("--calibration", params.calibration,
              "Calibration instead of the recording's own: of Kalibr, OpenVINS, VINS, EuRoC or OpenCV")
      .type("FILE.yaml")
      .repeatable();
  line.option("--camera,--image-topic", params.camera, "Camera to use, by its label, folder or topic").type("LABEL");
  line.option("--imu,--imu-topic", params.imu,
              "IMU to use, by its label, folder or topic; GYRO,ACCEL where they are two topics")
      .type("LABEL");
}

}  // namespace lintel
