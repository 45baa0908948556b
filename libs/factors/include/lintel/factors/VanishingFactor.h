// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImageFactor.h"
#include "lintel/factors/ImageObservations.h"

namespace lintel {

/// An image line whose direction in space is shared but whose distance nobody knows: its observation plane contains the
/// direction, that is, the image line passes the vanishing point:
///
///   r = weight (x_start x x_end) / |x_start x x_end| . R_c_w d
///
/// It depends on rotations only: no distance is guessed, which would constrain translations. `weight` = 1 / sigma of
/// the angle between plane and direction. Blocks: pose (T_w_b), extrinsics (T_b_c), correction, direction.
class VanishingFactor final : public ImageFactor<DirectionTarget> {
 public:
  VanishingFactor(const RayObservation& start, const RayObservation& end, const FrameMotion& motion, double weight)
      : ImageFactor(motion), start_(start), end_(end), weight_(weight) {}
  void linearise(const CameraView& view, const double* correction, const double* const& direction, bool jacobians,
                 DirectionLinearisation& out) const override;

 private:
  RayObservation start_, end_;
  double weight_;
};

}  // namespace lintel
