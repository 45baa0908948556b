// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/RigReport.h"

#include <cmath>

#include "GivenCalibration.h"
#include "SensorStream.h"
#include "lintel/sensing/Calibration.h"

namespace lintel {
namespace {

constexpr std::size_t kSamples = 500;  ///< some seconds of any IMU

/// Mean of the first samples; NaN when there is none.
Eigen::Vector3d meanAccel(SensorStream& stream) {
  const auto frame = stream.nextFrame([](Fault, const std::string&) {});
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  while (count < kSamples && frame) {
    const auto sample = stream.nextImu(frame->t_ns, [](Fault, const std::string&) {});
    if (!sample) break;
    sum += sample->accel;
    ++count;
  }
  return sum / count;
}

/// Cosine of the angle between a camera's downward axis and gravity, for a camera turned by `R_b_c`.
double uprightness(const Eigen::Matrix3d& R_b_c, const Eigen::Vector3d& mean_accel) {
  return -R_b_c.col(1).dot(mean_accel.normalized());
}

}  // namespace

std::vector<std::string> mountingDoubts(const Rig& rig, const Eigen::Vector3d& mean_accel) {
  std::vector<std::string> doubts;
  const double norm = mean_accel.norm();
  if (!std::isfinite(norm)) return doubts;
  if (std::abs(norm - 1) < 0.2)
    doubts.push_back("the accelerometer measures about 1 at first: is it in g? m/s^2 is needed");
  if (norm < 0.3) doubts.push_back("the accelerometer measures about 0 at first: gravity must not be taken out");
  if (std::abs(norm / rig.gravity_m_s2 - 1) > 0.2) return doubts;
  const Eigen::Matrix3d R_b_c = rig.T_b_c.q.toRotationMatrix();
  // 60 and 30 degrees: cameras are mounted upright, on their side or head, and tilted
  if (uprightness(R_b_c, mean_accel) < 0.5 && uprightness(R_b_c.transpose(), mean_accel) > 0.866)
    doubts.push_back(
        "the camera is not upright at first, but would be with the inverse of its pose: T_BS takes "
        "coordinates in the camera to the IMU, is the inverse given?");
  return doubts;
}

RigReport reportRig(const std::string& recording, const RecordingParams& params) {
  const GivenCalibration given(params);
  RigReport report;
  report.time_shift_s = -1e-9 * static_cast<double>(given.shift_ns());
  std::vector<Warning> warnings;
  if (recording.empty()) {
    report.rig = given.rig(
        []() -> Rig {
          throw RecordingError("the calibration does not say where the camera is on the IMU: add T_imu_cam");
        },
        warnings);
  } else {
    const auto stream = openStream(recording, params);
    report.rig = stream->rig();
    report.rig.gravity_m_s2 = params.gravity_m_s2;
    warnings = stream->openingWarnings();
    if (params.calibration.empty())
      for (std::string& doubt : rigDoubts(report.rig)) report.warnings.push_back(std::move(doubt));
    for (std::string& doubt : mountingDoubts(report.rig, meanAccel(*stream)))
      report.warnings.push_back(std::move(doubt));
  }
  for (Warning& warning : warnings) report.warnings.push_back(std::move(warning.text));
  return report;
}

}  // namespace lintel
