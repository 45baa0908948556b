// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

constexpr double kInformationFloor = 1e-6;  ///< of a covariance: a sigma of a thousand, in any unit

using Gauge = Eigen::Matrix<double, 4, kPoseTangent>;

/// The shift and the turn of the world that a pose's error amounts to.
inline Gauge gaugeOf(const WindowFrame& frame) {
  const Pose T = frame.T_w_b();
  Gauge gauge = Gauge::Zero();
  gauge.block<1, 3>(3, 3) = T.R().row(2);
  gauge.topLeftCorner<3, 3>().setIdentity();
  gauge.block<3, 3>(0, 3) = -Eigen::Vector3d::UnitZ().cross(T.p) * T.R().row(2);
  return gauge;
}

inline BlockKey poseOf(const WindowFrame& frame) { return {BlockKey::kPose, frame.id}; }

}  // namespace lintel
