// SPDX-License-Identifier: BSD-3-Clause
#include "GivenCalibration.h"

#include <cmath>

#include "TimeTicks.h"

namespace lintel {
namespace {

/// Beyond this two clocks are not those of one rig.
constexpr double kMaxShift_s = 1e6;

}  // namespace

GivenCalibration::GivenCalibration(const RecordingParams& params) : calibration_(readCalibration(params.calibration)) {
  const CameraCalibration* camera = chooseCamera(calibration_, params.camera);
  if (!camera) return;
  camera_ = *camera;
  camera_topic_ = camera->topic;
  if (std::abs(camera->time_shift_s) > kMaxShift_s)
    throw RecordingError(params.calibration.front() + ": the clocks of camera and IMU differ by more than a million " +
                         "seconds: correct the time shift");
  shift_ns_ = -std::llround(camera->time_shift_s * 1e9 / kTick_ns) * kTick_ns;
}

Rig GivenCalibration::rig(const std::function<Rig()>& own, std::vector<Warning>& warnings) const {
  if (!camera_ && !calibration_.imu_noise) return own();
  std::optional<Rig> recorded;
  if (camera_ && camera_->T_b_c) {
    try {
      recorded = own();
    } catch (const RecordingError&) {  // what the files say replaces it
    }
  } else {
    recorded = own();
  }
  Rig rig = recorded.value_or(Rig());
  if (camera_) {
    rig.camera = camera_->make();
    if (camera_->T_b_c) rig.T_b_c = *camera_->T_b_c;
    if (camera_->rate_hz) rig.camera_rate_hz = *camera_->rate_hz;
    if (camera_->line_delay_s) rig.line_delay_s = *camera_->line_delay_s;
  }
  if (calibration_.imu_noise)
    rig.imu_noise = *calibration_.imu_noise;
  else if (!recorded)
    warnings.push_back({Fault::Calibration,
                        "neither the calibration nor the recording has the IMU's noise densities: those of an "
                        "ADIS16448 are assumed; add Kalibr's imu.yaml by another --calibration"});
  if (calibration_.axes) rig.axes = *calibration_.axes;
  if (calibration_.imu_rate_hz) rig.imu_rate_hz = *calibration_.imu_rate_hz;
  for (std::string& doubt : rigDoubts(rig, -1e-9 * static_cast<double>(shift_ns_)))
    warnings.push_back({Fault::Calibration, "calibration: " + std::move(doubt)});
  return rig;
}

}  // namespace lintel
