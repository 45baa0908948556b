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
  line.option(
          "--times", params.times_file,
          "Of a film or a folder of images: a time a line, with or without a file's name; else looked for beside it")
      .type("FILE");
  line.option(
          "--imu-file", params.imu_file,
          "The same of the IMU: a time, angular rates and accelerations a line; GYRO,ACCEL where they are two files")
      .type("FILE");
}

}  // namespace lintel
