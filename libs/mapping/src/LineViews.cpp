// SPDX-License-Identifier: BSD-3-Clause
#include "LineViews.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lintel {

NearestToRay nearestToRay(const LineEstimate& line, const Eigen::Vector3d& p_w_c, const Eigen::Vector3d& ray_w) {
  constexpr double kLeastSine2 = 1e-9;  // of the angle between ray and line: avoids a division by zero
  const Eigen::Vector3d arm = line.middle_w - p_w_c;
  const double cosine = ray_w.dot(line.direction_w);
  NearestToRay nearest;
  nearest.sine2 = 1 - cosine * cosine;
  nearest.along_m = (cosine * ray_w.dot(arm) - line.direction_w.dot(arm)) / std::max(nearest.sine2, kLeastSine2);
  nearest.depth_m = ray_w.dot(arm) + nearest.along_m * cosine;
  return nearest;
}

std::optional<ViewStretch> viewStretch(const KeyframeCameras& cameras, const LineEstimate& line, const LineView& view) {
  // Sines of the angle between ray and line: below, the point nearest to the ray is not known.
  constexpr double kLeastSine = 0.05, kMostSine = 0.5, kSigmas = 3, kLeastDepth_m = 0.05;
  const double least_sine = std::clamp(kSigmas * line.sigmaDirection(), kLeastSine, kMostSine);
  const Eigen::Vector2d px[2] = {view.start_px.cast<double>(), view.end_px.cast<double>()};
  double places[2], m_per_px[2];
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector3d ray_w = (cameras.R_c_w(view.keyframe).transpose() * cameras.ray(px[k])).normalized();
    const NearestToRay nearest = nearestToRay(line, cameras.T_w_c(view.keyframe).p, ray_w);
    if (nearest.sine2 < least_sine * least_sine || nearest.depth_m <= kLeastDepth_m) return std::nullopt;
    places[k] = nearest.along_m;
    m_per_px[k] = nearest.depth_m / (std::sqrt(nearest.sine2) * cameras.camera().meanFocal());
  }
  return ViewStretch{places[0], places[1], m_per_px[0], m_per_px[1]};
}

double viewError(const KeyframeCameras& cameras, const LineEstimate& line, const LineView& view) {
  const Eigen::Vector3d& p_w_c = cameras.T_w_c(view.keyframe).p;
  const Eigen::Matrix3d& R_c_w = cameras.R_c_w(view.keyframe);
  const Eigen::Vector3d l = R_c_w * (line.middle_w - p_w_c).cross(line.direction_w);
  const double size = std::max(cameras.camera().wide() ? l.norm() : l.head<2>().norm(), 1e-12);
  double worst = 0;
  for (const Eigen::Vector2f& end_px : {view.start_px, view.end_px}) {
    const Eigen::Vector3d x = cameras.ray(end_px.cast<double>());
    if (nearestToRay(line, p_w_c, (R_c_w.transpose() * x).normalized()).depth_m <= 0)
      return std::numeric_limits<double>::infinity();
    worst = std::max(worst, std::abs(x.dot(l)) / size * cameras.camera().meanFocal());
  }
  return worst;
}

}  // namespace lintel
