// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/RowMotion.h"

#include <algorithm>

#include "lintel/factors/EdgeFit.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

double rowShare(const Camera& camera, const Eigen::Vector2d& px) {
  return (px.y() - 0.5 * (camera.height - 1)) / std::max(camera.height, 1);
}

RowMotion::RowMotion(const Pose& T_b_c, const FrameMotion& motion, const MotionChange& change) {
  const Eigen::Quaterniond R_c_b = T_b_c.q.conjugate();
  const Eigen::Vector3d turning_b = motion.omega_b.cross(T_b_c.p);
  v_c_ = R_c_b * (motion.v_b + turning_b);
  omega_c_ = R_c_b * motion.omega_b;
  a_c_ =
      R_c_b * (change.acceleration_b + change.angular_acceleration_b.cross(T_b_c.p) + motion.omega_b.cross(turning_b));
  alpha_c_ = R_c_b * change.angular_acceleration_b;
}

Eigen::Vector3d RowMotion::rayAtFrameTime(const Eigen::Vector3d& ray, double dt_s, double inverse_distance) const {
  const double half_square = 0.5 * dt_s * dt_s;
  return expRotation(omega_c_ * dt_s + alpha_c_ * half_square) * ray +
         (v_c_ * dt_s + a_c_ * half_square) * inverse_distance;
}

std::pair<Eigen::Vector2d, Eigen::Vector2d> lineAtFrameTime(
    const Camera& fitted, const Camera& camera, const Eigen::Vector2d& start_px, const Eigen::Vector2d& end_px,
    const std::function<Eigen::Vector3d(const Eigen::Vector2d&)>& ray_at_frame_time) {
  // offsets are taken in the plane that touches the sphere in the line's middle
  const Eigen::Vector3d middle = (fitted.ray(start_px).normalized() + fitted.ray(end_px).normalized()).normalized();
  const auto onPlane = [&](const Eigen::Vector3d& ray) -> Eigen::Vector3d { return ray / middle.dot(ray); };
  const Eigen::Vector3d start = onPlane(fitted.ray(start_px)), end = onPlane(fitted.ray(end_px));
  const Eigen::Vector3d across = middle.cross(end - start).normalized();
  const auto shift = [&](const Eigen::Vector2d& px) -> Eigen::Vector3d {
    return onPlane(ray_at_frame_time(px)) - onPlane(camera.ray(px));
  };
  double offset[2] = {0, 0};
  for (int i = 0; i < EdgeFit::kSamples; ++i) {
    const double node = EdgeFit::kNodes[i],
                 moved = across.dot(shift(fitted.project(0.5 * ((1 - node) * start + (1 + node) * end))));
    for (int k = 0; k < 2; ++k) offset[k] += EdgeFit::share(i, k == 0 ? -1 : 1) * moved;
  }
  const auto fittedEnd = [&](const Eigen::Vector2d& px, double across_offset) -> Eigen::Vector2d {
    const Eigen::Vector3d along = shift(px);
    const Eigen::Vector3d ray = onPlane(camera.ray(px)) + along + (across_offset - across.dot(along)) * across;
    return camera.projects(ray) ? camera.project(ray) : px;
  };
  return {fittedEnd(start_px, offset[0]), fittedEnd(end_px, offset[1])};
}

}  // namespace lintel
