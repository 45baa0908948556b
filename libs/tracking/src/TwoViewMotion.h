// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace lintel {

/// One point in two frames: its rays (Camera.h).
struct TwoViewPair {
  Eigen::Vector3d x0, x1;
};

/// Relative motion of two views from points, the rotation known roughly.
struct TwoViewMotion {
  Eigen::Vector3d delta = Eigen::Vector3d::Zero();        ///< R_c1_c0 = Exp(delta) * R_predicted [rad]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of delta, from the images only [1/rad^2]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();   ///< unit translation direction in c1, sign open
  std::vector<char> inlier;                               ///< per pair
  int inliers = 0;
  double cost = 0;  ///< robust chi-square of all pairs
};

struct TwoViewParams {
  double focal_px = 460;      ///< turns lengths of rays into pixels
  double threshold_px = 1.0;  ///< largest distance from the epipolar line
  double noise_px = 0.3;      ///< of a tracked position; scales `information`
  int hypotheses = 60;
  bool wide = false;  ///< whether rays are on the unit sphere
};

/// Epipolar consistency with a rotation known from the gyroscope: RANSAC over the translation direction (two points
/// each, drawn from a fixed sequence), then robust least squares on direction and a small rotation correction, whose
/// prior is `R_information`. Without any translation every point that follows the rotation is an inlier.
/// With fewer than 8 pairs all are inliers and nothing is estimated.
TwoViewMotion twoViewMotion(const std::vector<TwoViewPair>& pairs, const Eigen::Quaterniond& R_predicted,
                            const Eigen::Matrix3d& R_information, const TwoViewParams& params);

}  // namespace lintel
