// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

struct SplineFitParams {
  double knot_spacing_s = 0.08;  ///< [s]
  double position_hz = 2.0;      ///< motions of this frequency keep half their amplitude: above are noise and jumps
  double rotation_hz = 6.0;      ///< the same of the rotation
};

/// A quintic (C4) uniform B-spline through measured poses: three positions and the four components of a quaternion that
/// is normalised afterwards. What the spline smooths away is no longer part of the motion: it is the truth from here
/// on.
class SplineTrajectory : public Trajectory {
 public:
  /// Time 0 is the first pose's. Throws std::invalid_argument for fewer than 8 poses, less than 1 s, or times that do
  /// not ascend.
  explicit SplineTrajectory(const StampedPoses& poses, const SplineFitParams& params = {});

  /// Beyond [0, duration()] the pose of the nearer end.
  KinematicState at(double t_s) const override;
  double duration() const override { return duration_s_; }

 private:
  double duration_s_, spacing_s_;
  Eigen::MatrixXd controls_;  // one row per control point: x y z, qx qy qz qw
};

}  // namespace lintel
