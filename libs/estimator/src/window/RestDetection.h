// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <unordered_map>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Whether nothing has moved between the two newest frames, for the images, the IMU and the estimate.
bool isQuiet(const SlidingWindow& window, const EstimatorParams& params);

/// Tells when the body rests: when it is quiet, or when the images of a second show that it has not moved although the
/// IMU trembles, as on a vehicle whose motors run before it takes off. Nothing else holds the estimate then: points
/// that were never seen from two places do not, and vibration shifts the accelerometer's mean by some 0.03 m/s^2. How
/// far away the points are does not matter: what hovers or is carried turns by more than these images allow.
class RestDetection {
 public:
  explicit RestDetection(const EstimatorParams& params) : params_(params) {}

  /// Takes the window's newest frame in.
  void add(const SlidingWindow& window);

  /// Whether the body rests at the frame taken in last.
  bool atRest(const SlidingWindow& window) const;

  /// Whether the images of a second show no motion; so it has not moved since the frame before, whatever the IMU says.
  bool imagesRest() const;

 private:
  struct View {
    std::int64_t t_ns = 0;
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< since the view before, by the gyroscope
    std::unordered_map<TrackId, Eigen::Vector2d> points_px;
  };

  EstimatorParams params_;
  std::deque<View> views_;
};

}  // namespace lintel
