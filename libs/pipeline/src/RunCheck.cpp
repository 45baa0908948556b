// SPDX-License-Identifier: BSD-3-Clause
#include "RunCheck.h"

#include <cmath>

#include "ImageRemarks.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

// What is carried, drives or flies slowly does not gain 15 m/s in five seconds; a gravity that is tilted by 18 degrees
// against the estimate's, or an accelerometer that is not what it is taken for, makes it seem so.
constexpr std::int64_t kSpan_ns = 5'000'000'000;
constexpr double kLargestAcceleration = 3;  // [m/s^2]
// Cars and racing drones gain more: they are believed where images and the IMU agree with it at all keyframes.
constexpr double kLargestConfirmed = 20;
constexpr double kLongLever_m = 2;  // longer than what holds a camera and its IMU
constexpr double kFewPoses = 0.25;  // of all frames
constexpr double kLeastShareWithPose = 0.5;

// How far the estimated calibration may go from the given one: some times what a rough calibration is wrong by (focal
// length 2 %, mounting 3 degrees and some centimetres). Farther away it takes up errors that are not the camera's, or
// the camera is another. A moved centre turns the rays nearly as a turned mounting does. The distortion may come from
// none given: it has no limit.
constexpr double kLargestFocalChange = 0.05, kLargestTurn_rad = 0.12, kLargestMove_m = 0.2;

// Squared misfits of the IMU between keyframes have nine degrees of freedom: a median of 8.3, or 25 times as much where
// the IMU errs five times as much as its noise says (vibration).
constexpr double kExpectedMisfit = 8.3;
constexpr std::size_t kLeastMisfits = 50;  // in the first seconds biases and calibration have not settled
constexpr double kLargestImuMisfit = 25 * kExpectedMisfit;
// Of velocity and position alone six are left, a median of 5.35. Between keyframes of one solve they have been fitted:
// flights, walkers, hands and drones have medians of up to 2, the real flights of MH_01, which vibrate, of up to 5.1,
// vibrations that were sampled too slowly 12 and more, and scales that are wrong by up to a fifth. (As each left the
// window, keyframes of drones 60 m away from what they see differ by seven times the IMU's noise, and nothing is
// wrong.)
constexpr double kLargestImuError = 1.25;  // times its noise, RMS; of the refinement, too
constexpr double kLargestAccelMisfit = 5.35 * kLargestImuError * kLargestImuError;
// The refinement knows the calibration from the beginning on. On six runs whose samples of a vibration were dropped, or
// delayed by a filter, its IMU errs by 1.3 to 3.5 times its noise (RMS); on others by 0.2 to 1.2. What passes is a
// flight with every fourth sample (1.1, its scale 6.5 % off).
// Less is enough where other axes of the accelerometer would fit gravity so much better: motion alone makes it up
// to 1.7, that of a drone that looks down from 40 m 3.2. A refinement excuses that where its IMU errs by less than half
// of its noise: 0.2 on that drone, 0.7 and more on runs with interchanged axes.
constexpr double kSuspectImuMisfit = 2 * kExpectedMisfit, kOtherAxesFit = 2.5, kSmallImuError = 0.5;

/// Whether images and IMU agree, whatever the window made of them.
bool excuses(const RefinementReport& refinement, double largest_imu_error = kLargestImuError) {
  return refinement.accepted && refinement.imu_after < largest_imu_error;
}

std::string calibrationFault(const Rig& given, const Rig& estimated) {
  const double focal = estimated.camera.meanFocal() / given.camera.meanFocal() - 1;
  const double turn_rad = given.T_b_c.q.angularDistance(estimated.T_b_c.q);
  const double move_m = (estimated.T_b_c.p - given.T_b_c.p).norm();
  const double centre_px = std::hypot(estimated.camera.cx - given.camera.cx, estimated.camera.cy - given.camera.cy);
  if (std::abs(focal) <= kLargestFocalChange && turn_rad <= kLargestTurn_rad && move_m <= kLargestMove_m &&
      centre_px <= kLargestTurn_rad * given.camera.meanFocal())
    return {};
  return formatted(
      "the estimate left the given calibration: focal length %+.0f %%, centre moved by %.0f px, mounting "
      "turned by %.0f degrees and moved by %.0f cm",
      100 * focal, centre_px, turn_rad * 57.29577951, 100 * move_m);
}

}  // namespace

void RunCheck::add(const TrackedFrame& frame, const WindowUpdate& update) {
  const ImuBatch& imu = frame.step.imu;
  turns_.add(imu, frame.turn);
  if (update.status == EstimatorStatus::kTracking) bias_gyro_ = update.bias.gyro;
  accelerometer_.add(imu, bias_gyro_);
  noise_.add(imu);
  sigma_.add(update);
  watchSpeed(update);
  watchImu(update);
  watchFailures(update);
}

void RunCheck::watchFailures(const WindowUpdate& update) {
  if (first_ns_ < 0) first_ns_ = update.t_ns;
  if (update.failure != Failure::kDiverged || !divergence_.empty()) return;
  divergence_ = formatted("the estimate diverged at %.1f s: ", 1e-9 * static_cast<double>(update.t_ns - first_ns_)) +
                update.reason;
}

void RunCheck::watchImu(const WindowUpdate& update) {
  if (update.status == EstimatorStatus::kTracking) {
    biases_gyro_.push_back(update.bias.gyro.norm());
    biases_accel_.push_back(update.bias.accel.norm());
  }
  for (const RetiredKeyframe& keyframe : update.keyframes) {
    const InertialState state{keyframe.T_w_b, keyframe.v_w_b, keyframe.bias};
    if (keyframe_ && keyframe.imu) {
      const Preintegration imu = withAxes(*keyframe.imu, keyframe.axes);
      imu_misfits_.push_back(squaredMisfit(*keyframe_, state, imu));
      if (next_) accel_misfits_.push_back(squaredAccelMisfit(*keyframe_, *next_, imu));
    }
    keyframe_ = state;
    next_ = keyframe.next;
  }
}

void RunCheck::watchSpeed(const WindowUpdate& update) {
  if (!update.hasPose()) speeds_.clear();
  if (update.status != EstimatorStatus::kTracking) return;
  speeds_.push_back({update.t_ns, update.v_w_b});
  if (update.t_ns - speeds_.front().t_ns < kSpan_ns) return;
  const double dt = 1e-9 * static_cast<double>(update.t_ns - speeds_.front().t_ns);
  const double acceleration = (update.v_w_b - speeds_.front().v_w_b).norm() / dt;
  if (!(acceleration <= largest_acceleration_)) largest_acceleration_ = acceleration;  // NaN, too
  speeds_.pop_front();
}

std::map<std::string, double> RunCheck::evidence() const {
  std::map<std::string, double> values{{"gravity_m_s2", accelerometer_.gravity()}};
  const TurnFit turns = turns_.fit();
  values["turns_compared"] = turns.compared;
  values["turns_missed"] = turns.missed;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const std::string at = std::string(1, "xyz"[i]) + "xyz"[k];
      values["turns_" + at] = turns.M(i, k);
      values["turns_" + at + "_sigma"] = turns.sigma(i, k);
    }
  values["accelerometer_axes_misfit"] = accelerometer_.axesMisfit();
  values["largest_acceleration_m_s2"] = largest_acceleration_;
  values["position_sigma"] = sigma_.worst();
  const auto quantiles = [&](const std::string& name, std::vector<double> sample) {
    if (sample.empty()) return;
    values[name + "_median"] = upperQuantile(sample, 0.5);
    values[name + "_90"] = upperQuantile(sample, 0.9);
  };
  quantiles("imu_misfit", imu_misfits_);
  quantiles("accel_misfit", accel_misfits_);
  quantiles("bias_gyro", biases_gyro_);
  quantiles("bias_accel", biases_accel_);
  return values;
}

bool RunCheck::agree(const RefinementReport& refinement) const {
  if (refinement.rounds > 0) return excuses(refinement);
  // As each left the window, keyframes of an estimate that diverges are off by ten times the IMU's noise and more.
  std::vector<double> misfits = imu_misfits_;
  return misfits.size() >= kLeastMisfits && upperQuantile(misfits, 0.5) < kExpectedMisfit;
}

std::string RunCheck::symptom(const OdometryStatistics& s, const Rig& estimated,
                              const RefinementReport& refinement) const {
  const double after_first = static_cast<double>(s.last_frame_ns - s.first_frame_ns) * 1e-9 - s.first_start_s;
  const double all = static_cast<double>(s.last_frame_ns - s.first_frame_ns) * 1e-9;
  const double expected = s.first_start_s < 0 || all <= 0 ? 0 : static_cast<double>(s.frames) * after_first / all;
  if (!(largest_acceleration_ < (agree(refinement) ? kLargestConfirmed : kLargestAcceleration))) {
    return formatted("the estimate diverged: it gained %.0f m/s within 5 s", 5 * largest_acceleration_);
  }
  if (!divergence_.empty()) return divergence_;
  if (s.resets > 0 && static_cast<double>(s.frames_with_pose) < kLeastShareWithPose * expected) {
    return formatted("the estimate did not last: %zu starts, poses for %.0f %% of the frames", s.resets + 1,
                     100 * static_cast<double>(s.frames_with_pose) / static_cast<double>(s.frames));
  }
  // No fault by itself, as after a long rest; but a smaller contradiction may be why.
  const double share = s.frames > 0 ? static_cast<double>(s.frames_with_pose) / static_cast<double>(s.frames) : 1;
  if (share < kFewPoses && !turns_.fault(Suspicion::kSome, clock_offset_s_).empty())
    return formatted("poses for only %.0f %% of the frames", 100 * share);
  const std::string fault = imuFault(refinement);
  return fault.empty() ? calibrationFault(rig_, estimated) : fault;
}

std::string RunCheck::imuFault(const RefinementReport& refinement) const {
  std::vector<double> misfits = imu_misfits_;
  if (misfits.size() < kLeastMisfits) return {};
  const double misfit = upperQuantile(misfits, 0.5);
  const bool other_axes = accelerometer_.axesMisfit() > kOtherAxesFit && !excuses(refinement, kSmallImuError);
  if (misfit < (other_axes ? kSuspectImuMisfit : kLargestImuMisfit)) return accelFault(refinement);
  return formatted("images and IMU contradict each other: the IMU is off by %.1f times its noise between keyframes",
                   std::sqrt(misfit / kExpectedMisfit));
}

std::string RunCheck::accelFault(const RefinementReport& refinement) const {
  std::vector<double> misfits = accel_misfits_;
  if (misfits.size() < kLeastMisfits) return {};
  const double misfit = upperQuantile(misfits, 0.5);
  if (misfit < kLargestAccelMisfit || excuses(refinement)) return {};
  return "images and accelerometer contradict each other, as where a vibration was sampled too slowly or samples were "
         "dropped: the size of everything may be wrong; record all samples, or their means";
}

std::string RunCheck::cause(const OdometryStatistics& s) const {
  if (std::string fault = imageFault(s.front_end); !fault.empty()) return fault;
  if (std::string fault = turns_.fault(Suspicion::kSome, clock_offset_s_); !fault.empty()) return fault;
  if (std::string fault = accelerometer_.axesFault(); !fault.empty()) return fault;
  if (const double lever_m = rig_.T_b_c.p.norm(); lever_m > kLongLever_m) {
    return formatted("T_BS says that the camera is %.1f m away from the IMU: check its unit (m)", lever_m);
  }
  if (std::string fault = textureFault(s.front_end.points); !fault.empty()) return fault;
  if (!turns_.agree()) return {};
  if (s.frames_with_pose == 0 && s.main_wait == kScaleUnknown)
    return "the camera may accelerate too little to show the scale above the IMU's noise: start where it moves more "
           "strongly (--from), or look at the accelerometer (its sign: at rest it shows 9.8 m/s^2 upwards; unit)";
  return "camera and gyroscope turn together, so look at the accelerometer (its sign: at rest it shows 9.8 m/s^2 "
         "upwards; axes, unit), the distance in T_BS, the intrinsics and the distortion";
}

std::string RunCheck::verdict(const OdometryStatistics& s, const Rig& estimated,
                              const RefinementReport& refinement) const {
  // The gyroscope first: what the accelerometer shows is turned by it.
  if (const std::string fault = turns_.fault(Suspicion::kNone, clock_offset_s_); !fault.empty()) {
    const std::string images = imageFault(s.front_end);
    return images.empty() ? fault : images + "; " + fault;
  }
  if (std::string fault = accelerometer_.sizeFault(); !fault.empty()) return fault;
  const bool no_pose = s.frames_with_pose == 0;
  std::string fault = no_pose ? "no pose was found (" + s.main_wait + ")" : symptom(s, estimated, refinement);
  if (fault.empty()) return sigma_.fault();
  const std::string likely = cause(s);
  if (!likely.empty()) return fault + "; " + likely;
  return no_pose ? "" : fault + "; check that IMU and images belong together, T_BS of both, and the calibration";
}

}  // namespace lintel
