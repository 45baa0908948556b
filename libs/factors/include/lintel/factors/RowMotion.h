// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>

#include "lintel/factors/FrameMotion.h"
#include "lintel/geometry/Camera.h"
#include "lintel/geometry/Pose.h"
#include "lintel/inertial/ImuAt.h"

namespace lintel {

/// When a rolling shutter exposes the row of a pixel, as a share of the image's readout after the frame's time: -0.5
/// (first row) to 0.5 (last row).
double rowShare(const Camera& camera, const Eigen::Vector2d& px);

/// A camera while a rolling shutter reads its image, with constant acceleration: from the frame's time to dt later it
/// moves by p(dt) = v_c dt + a_c dt^2 / 2 and turns by Exp(w_c dt + alpha_c dt^2 / 2), in its axes at the frame's time.
class RowMotion {
 public:
  RowMotion(const Pose& T_b_c, const FrameMotion& motion, const MotionChange& change);

  /// Where at the frame's time it would see what it sees along the unit `ray` at `dt_s` after it [s], at a distance of
  /// 1 / `inverse_distance` [m]: Exp(..) ray + p(dt) inverse_distance.
  Eigen::Vector3d rayAtFrameTime(const Eigen::Vector3d& ray, double dt_s, double inverse_distance) const;

 private:
  Eigen::Vector3d v_c_, omega_c_, a_c_, alpha_c_;
};

/// The ends of the line that fits an edge at the frame's time best [px]: the rows between its ends are moved too, and
/// leave a straight edge bent. `fitted`: the camera in which the line from `start_px` to `end_px` is straight;
/// `camera`: the true one; `ray_at_frame_time`: of a pixel of the image. An end that the camera does not see then
/// stays.
std::pair<Eigen::Vector2d, Eigen::Vector2d> lineAtFrameTime(
    const Camera& fitted, const Camera& camera, const Eigen::Vector2d& start_px, const Eigen::Vector2d& end_px,
    const std::function<Eigen::Vector3d(const Eigen::Vector2d&)>& ray_at_frame_time);

}  // namespace lintel
