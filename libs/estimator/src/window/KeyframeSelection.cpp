// SPDX-License-Identifier: BSD-3-Clause
#include "window/KeyframeSelection.h"

#include <algorithm>
#include <cmath>

#include "initialisation/Initializer.h"

namespace lintel {

bool secondNewestIsKeyframe(const SlidingWindow& window, const EstimatorParams& params) {
  const std::size_t n = window.frames.size();
  if (n < 3) return true;
  const WindowFrame &before = window.frames[n - 3], &candidate = window.frames[n - 2];
  if (1e-9 * static_cast<double>(candidate.t_ns - before.t_ns) > params.max_keyframe_interval_s) return true;
  double sum = 0;
  int shared = 0;
  for (const auto& [id, track] : window.points) {
    const PointSighting *a = nullptr, *b = nullptr;
    for (const PointSighting& s : track.sightings) {
      if (s.frame == before.id) a = &s;
      if (s.frame == candidate.id) b = &s;
    }
    if (!a || !b) continue;
    sum += (a->observation.ray - b->observation.ray).norm();
    ++shared;
  }
  if (shared < params.keyframe_min_tracked) return true;
  return sum / shared * window.camera().meanFocal() >= params.keyframe_parallax_px;
}

bool isAtRest(const SlidingWindow& window, const EstimatorParams& params) {
  const std::size_t n = window.frames.size();
  if (!params.detect_rest || n < 2) return false;
  // far points do not show a slow uniform motion, nor does the IMU
  if (velocityOf(window.frames[n - 1].motion.data()).norm() > params.rest_speed) return false;
  const double disparity = medianDisparityPx(window, n - 2, n - 1, false);
  if (disparity < 0 || disparity > params.rest_disparity_px) return false;
  const Preintegration* imu = window.frames[n - 1].imu.get();
  if (!imu || imu->samples().size() < 5) return false;
  Eigen::Vector3d mean_gyro = Eigen::Vector3d::Zero(), mean_accel = Eigen::Vector3d::Zero();
  for (const ImuSample& s : imu->samples()) mean_gyro += s.gyro, mean_accel += s.accel;
  const auto count = static_cast<double>(imu->samples().size());
  mean_gyro /= count;
  mean_accel /= count;
  double gyro = 0, accel = 0;
  for (const ImuSample& s : imu->samples()) {
    gyro += (s.gyro - mean_gyro).squaredNorm();
    accel += (s.accel - mean_accel).squaredNorm();
  }
  return std::sqrt(gyro / count) < params.initializer.static_gyro_std &&
         std::sqrt(accel / count) < params.initializer.static_accel_std;
}

namespace {
template <class Tracks>
int seenIn(const Tracks& tracks, FrameId frame) {
  return static_cast<int>(std::count_if(tracks.begin(), tracks.end(), [frame](const auto& entry) {
    return !entry.second.sightings.empty() && entry.second.sightings.back().frame == frame;
  }));
}
}  // namespace

int pointsInNewest(const SlidingWindow& window) { return seenIn(window.points, window.frames.back().id); }
int linesInNewest(const SlidingWindow& window) { return seenIn(window.lines, window.frames.back().id); }

}  // namespace lintel
