// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImageFactor.h"
#include "lintel/geometry/Camera.h"

namespace lintel {

/// Reprojection of a homogeneous point (X, w), X / w relative to the constant world point `origin_w`, in raw pixels:
///
///   g = R_c_w (X + w (origin_w - p_w_c)),    r = (camera(g) - px) / sigma_px
///
/// Every sighting has its residual, the first one too. (Inverse depth along a ray fixed by the first sighting takes
/// that sighting as exact: its noise then biases depth, and with it focal length and extrinsics.) Points at infinity
/// are regular: w = 0. Of a rolling shutter, g is moved to the time of the point's row, to first order in what the
/// readout is wrong by. Blocks: pose (T_w_b), extrinsics (T_b_c), correction, point.
class PointFactor final : public ImageFactor<PointTarget> {
 public:
  PointFactor(const Eigen::Vector2d& px, const Camera& camera, const FrameMotion& motion,
              const Eigen::Vector3d& origin_w, double sigma_px, const RowTime& row = {})
      : ImageFactor(motion), px_(px), camera_(camera), origin_w_(origin_w), weight_(1 / sigma_px), row_(row) {}
  void linearise(const CameraView& view, const double* correction, const double* const& point, bool jacobians,
                 PointLinearisation& out) const override;

 private:
  Eigen::Vector2d px_;
  Camera camera_;
  Eigen::Vector3d origin_w_;
  double weight_;
  RowTime row_;
};

}  // namespace lintel
