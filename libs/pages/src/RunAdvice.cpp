// SPDX-License-Identifier: BSD-3-Clause
#include "RunAdvice.h"

#include <algorithm>
#include <cmath>

#include "Degrees.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/reporting/Table.h"

namespace lintel {

namespace {

// Limits of what is usual: results of good recordings lie well within.
constexpr double kLateStart_s = 5;
constexpr int kFewPoints = 25;
constexpr double kFewPointsShare = 0.05;
constexpr double kFocalChange = 0.01, kTurned_rad = 0.015, kMoved_m = 0.015, kTimeOffset_s = 0.004,
                 kOffsetChange_s = 0.003;
constexpr double kLargeGyroBias_rad_s = 0.15, kLargeAccelBias_m_s2 = 0.8;
constexpr double kDegenerateShare = 0.7;

class Adviser {
 public:
  Adviser(const OdometryResult& result, const Rig& calibration, const RunSeries& series)
      : result_(result), s_(result.statistics), calibration_(calibration), series_(series) {}

  std::vector<std::string> advice(const std::vector<std::string>& recording_warnings) {
    start();
    resets();
    blindness();
    if (!result_.error.empty()) say("The recording ended early: " + result_.error + ".");
    points();
    lines();
    calibration();
    biases();
    for (const std::string& warning : recording_warnings) say("Reading the recording: " + warning + ".");
    return advice_;
  }

 private:
  void say(std::string text) { advice_.push_back(std::move(text)); }

  void start() {
    if (s_.frames_with_pose == 0) {
      say("No pose was found" + (s_.main_wait.empty() ? std::string() : " (" + s_.main_wait + ")") +
          ". Start where the camera moves sideways and sees texture (--from), and check camera calibration, camera-IMU "
          "rotation and that IMU and images carry times of one clock.");
    } else if (s_.first_pose_s > kLateStart_s) {
      say("The first pose came after " + fixedText(s_.first_pose_s, 1) +
          " s: what lies before has none. Moving sideways for a second right at the start, or resting there, makes it "
          "earlier.");
    }
  }

  void resets() {
    if (s_.resets == 0) return;
    std::string list;
    for (const std::string& failure : s_.failures) list += (list.empty() ? "" : "; ") + failure;
    say("The estimate was lost " + std::to_string(s_.resets) + " times and began anew (" + list +
        "): positions before and after do not share a frame, except in the refined result where places in common "
        "joined the pieces. Look at these times in the recording: darkness, blur, a "
        "covered lens, or missing images are the usual reasons.");
  }

  void blindness() {
    for (const Stretch& blind : s_.blind)
      say("From " + fixedText(blind.from_s, 1) + " to " + fixedText(blind.to_s, 1) +
          " s the images showed next to nothing that could be followed: the IMU alone carried the poses there, and the "
          "error grows with the square of the time. Darkness and a covered lens are the usual reasons.");
  }

  void points() {
    std::size_t in_window = 0, few = 0, rest = 0;
    for (const RunFrame& frame : series_.frames()) {
      if (!frame.in_window) continue;
      ++in_window;
      few += frame.points_used < kFewPoints;
      rest += frame.at_rest;
    }
    if (in_window == 0) return;
    const double share = static_cast<double>(few) / static_cast<double>(in_window);
    if (share > kFewPointsShare)
      say("In " + fixedText(100 * share, 0) + " % of the frames fewer than " + std::to_string(kFewPoints) +
          " points carried the estimate. More light, a shorter exposure or a lower tracking.points.min_quality give "
          "more; "
          "lines help where texture is missing.");
    if (rest == in_window) say("The camera rested all the time: there is no motion to map from.");
  }

  void lines() {
    if (s_.mean_lines_placed <= 0) return;
    const double share = s_.mean_lines_degenerate / s_.mean_lines_placed;
    if (share > kDegenerateShare)
      say(fixedText(100 * share, 0) +
          " % of the lines in the window were degenerate: the camera moves along them, so their own views leave "
          "direction or depth "
          "open. They are kept with that uncertainty; sideways motion settles it.");
    if (result_.map.lines.empty())
      say("The map holds no lines although lines were tracked: no line was seen from places far enough apart. Move "
          "sideways, or lower map.min_observations.");
  }

  void calibration() {
    const Camera &before = calibration_.camera, &after = result_.rig.camera;
    if (s_.frames_with_pose == 0 || before.fx <= 0) return;
    const double focal = after.meanFocal() / before.meanFocal() - 1;
    if (std::abs(focal) > kFocalChange)
      say("The focal length was refined by " + fixedText(100 * focal, 2) +
          " %: the calibration does not fit this camera. Calibrate it again, with the lens as it was in this "
          "recording.");
    const Pose difference = calibration_.T_b_c.inverse() * result_.rig.T_b_c;
    const double turned = logRotation(difference.q).norm();
    if (turned > kTurned_rad)
      say("The rotation between camera and IMU was refined by " + fixedText(kDegrees * turned, 2) +
          " degrees. Check T_BS: which way it maps and which axes it means.");
    if (difference.p.norm() > kMoved_m)
      say("The camera's place on the IMU was refined by " + fixedText(100 * difference.p.norm(), 1) +
          " cm. Measure it, or give its uncertainty (estimator.calibration.extrinsic_translation_sigma_m).");
    if (std::abs(result_.time_offset_s) > kTimeOffset_s)
      say("Images and IMU differ by " + fixedText(1000 * result_.time_offset_s, 1) +
          " ms. It was taken care of; better is to synchronise them, or to correct the stamps.");
    const RefinementReport& refined = result_.refinement;
    if (refined.accepted && refined.most_offset_s - refined.least_offset_s > kOffsetChange_s)
      say("The offset between images and IMU changed by " +
          fixedText(1000 * (refined.most_offset_s - refined.least_offset_s), 1) +
          " ms on the way. Where light is poor a camera exposes longer, and its stamps come later; or a clock drifts. "
          "The "
          "refined trajectory and the map take it into account, the causal trajectory does not: fix the exposure time, "
          "or "
          "give stamps of the middle of the exposure.");
  }

  void biases() {
    Eigen::Vector3d gyro = Eigen::Vector3d::Zero(), accel = Eigen::Vector3d::Zero();
    for (const RunFrame& frame : series_.frames()) {
      if (!frame.in_window) continue;
      gyro = gyro.cwiseMax(frame.bias.gyro.cwiseAbs());
      accel = accel.cwiseMax(frame.bias.accel.cwiseAbs());
    }
    if (gyro.maxCoeff() > kLargeGyroBias_rad_s)
      say("The gyroscope's bias reached " + fixedText(gyro.maxCoeff(), 2) +
          " rad/s, which few gyroscopes have. Check its unit (rad/s) and the rotation between camera and IMU.");
    if (accel.maxCoeff() > kLargeAccelBias_m_s2)
      say("The accelerometer's bias reached " + fixedText(accel.maxCoeff(), 2) +
          " m/s^2, which few have. Check its unit (m/s^2, gravity included) and the rotation between camera and IMU.");
  }

  const OdometryResult& result_;
  const OdometryStatistics& s_;
  const Rig& calibration_;
  const RunSeries& series_;
  std::vector<std::string> advice_;
};

}  // namespace

std::vector<std::string> adviceFor(const OdometryResult& result, const Rig& calibration, const RunSeries& series,
                                   const std::vector<std::string>& recording_warnings) {
  return Adviser(result, calibration, series).advice(recording_warnings);
}

}  // namespace lintel
