// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Errors of keyframes' bodies, drawn some times, from those of a few.
class BodyErrors {
 public:
  using Draws = Eigen::Matrix<double, 6, kErrorDraws>;  ///< shift [m], then turn [rad], world axes

  BodyErrors(std::vector<Pose> T_w_b, std::vector<std::int64_t> t_ns);

  /// Errors in the tangent space of a pose block: p + dp, R Exp(dtheta).
  void set(std::size_t keyframe, const Draws& tangent);

  /// Those of the keyframes between `set`, ascending, linearly in time.
  void interpolate(const std::vector<std::size_t>& set);

  /// Takes away what moves the trajectory as a whole: a map is compared with the world after its trajectory was laid
  /// onto the true one, as rigid bodies, by the positions.
  void align();

  /// Those of the cameras, with the errors of T_b_c in its tangent space.
  std::vector<CameraErrors> ofCamera(const Pose& T_b_c, const Draws& extrinsics) const;

 private:
  std::vector<Pose> T_w_b_;
  std::vector<std::int64_t> t_ns_;
  std::vector<Draws> errors_;
};

/// Relative standard deviation of the size of everything: of the scale in which the drawn ways of the cameras differ
/// from the estimated one. 0 when errors are not known, or for a camera that stays in one place.
double scaleSigma(const MapMaterial& material);

/// What errors of the cameras make of a line that is fitted to its views: the covariance of (a, b) (LineFitting.h) that
/// they add to that of the views' own errors; zero when errors are not known.
Eigen::Matrix4d covarianceByCameras(const KeyframeCameras& cameras, const std::vector<CameraErrors>& errors,
                                    const LineRecord& line);

}  // namespace lintel
