// SPDX-License-Identifier: BSD-3-Clause
#include "window/RestDetection.h"

#include <algorithm>
#include <vector>

#include "initialisation/Initializer.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"
#include "window/ImuStatistics.h"

namespace lintel {
namespace {

constexpr std::size_t kLeastPoints = 10;  // that two images share
constexpr double kMaxTurn_rad_s = 0.02;  // by the gyroscope, its bias left over: more, and images show what moves along

double medianShift_px(const std::unordered_map<TrackId, Eigen::Vector2d>& a,
                      const std::unordered_map<TrackId, Eigen::Vector2d>& b) {
  std::vector<double> shifts;
  for (const auto& [id, px] : a)
    if (const auto other = b.find(id); other != b.end()) shifts.push_back((px - other->second).norm());
  return shifts.size() < kLeastPoints ? -1 : upperMedian(shifts);
}

}  // namespace

bool isQuiet(const SlidingWindow& window, const EstimatorParams& params) {
  const std::size_t n = window.frames.size();
  if (n < 2) return false;
  // far points do not show a slow uniform motion, nor does the IMU
  if (velocityOf(window.frames[n - 1].motion.data()).norm() > params.rest_speed) return false;
  const double disparity = medianDisparityPx(window, n - 2, n - 1, false);
  if (disparity < 0 || disparity > params.rest_disparity_px) return false;
  const ImuStatistics imu = imuStatistics(window, n - 1);
  return imu.samples >= 5 && imu.std_gyro < params.initializer.static_gyro_std &&
         imu.std_accel < params.initializer.static_accel_std;
}

void RestDetection::add(const SlidingWindow& window) {
  const WindowFrame& newest = window.frames.back();
  View view;
  view.t_ns = newest.t_ns;
  if (newest.imu) view.turned = newest.imu->deltaR();
  for (const auto& [id, track] : window.points)
    if (!track.sightings.empty() && track.sightings.back().frame == newest.id)
      view.points_px.emplace(id, track.sightings.back().seen_px);
  views_.push_back(std::move(view));
  // the oldest one is at least that old
  const auto span_ns = static_cast<std::int64_t>(1e9 * params_.rest_images_s);
  while (views_.size() > 2 && newest.t_ns - views_[1].t_ns >= span_ns) views_.pop_front();
}

bool RestDetection::atRest(const SlidingWindow& window) const {
  return params_.detect_rest && (isQuiet(window, params_) || imagesRest());
}

bool RestDetection::imagesRest() const {
  if (!params_.detect_rest || views_.size() < 3 ||
      1e-9 * static_cast<double>(views_.back().t_ns - views_.front().t_ns) < params_.rest_images_s)
    return false;
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  for (std::size_t k = 1; k < views_.size(); ++k) turned = turned * views_[k].turned;
  if (logRotation(turned).norm() > kMaxTurn_rad_s * params_.rest_images_s) return false;
  for (std::size_t k = 0; k + 1 < views_.size(); ++k) {
    const double shift_px = medianShift_px(views_[k].points_px, views_.back().points_px);
    if (shift_px < 0 || shift_px > params_.rest_images_px) return false;
  }
  return true;
}

}  // namespace lintel
