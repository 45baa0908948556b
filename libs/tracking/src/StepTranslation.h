// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <vector>

#include "lintel/core/FrameTracks.h"

namespace lintel {

/// Where a point or a line's end is, as an inverse depth in the unit of StepTranslation, with its variance.
struct InverseDepth {
  double w = 0, variance = 0;
};

/// The camera's translation in the last step, in a unit of its own that stays the same from step to step: the tracked
/// points' inverse depths carry it on. The direction is that of the points' epipolar lines. With it the
/// motion of a feature of known depth is predicted for any motion of the camera.
class StepTranslation {
 public:
  struct Pair {
    TrackId id;
    Eigen::Vector3d x0, x1;  ///< rays in both frames (Camera.h)
  };

  /// `wide`: rays are on the unit sphere, and depths are distances.
  explicit StepTranslation(double focal_px, bool wide = false) : focal_px_(focal_px), wide_(wide) {}

  /// `direction_c1`: unit translation of the old camera seen from the new one, sign open; empty when it is not known.
  void update(const std::vector<Pair>& pairs, const Eigen::Quaterniond& R_c1_c0,
              const std::optional<Eigen::Vector3d>& direction_c1);

  /// Origin of the old camera in the new one's frame.
  const Eigen::Vector3d& t_c1() const { return t_c1_; }
  /// Inverse depths are valid within one epoch; the unit is lost when too few points continue.
  int epoch() const { return epoch_; }
  /// Median inverse depth of the points; 0 without any.
  double typicalInverseDepth() const { return typical_; }

 private:
  struct Ray;
  std::vector<Ray> raysOf(const std::vector<Pair>& pairs, const Eigen::Quaterniond& R_c1_c0) const;
  double lengthOf(const std::vector<Ray>& rays, const Eigen::Vector3d& direction) const;
  void updatePoints(const std::vector<Ray>& rays, const Eigen::Vector3d& direction, double length);

  /// Depth that a ray gains with the translation `t_c1`.
  double along(const Eigen::Vector3d& x, const Eigen::Vector3d& t_c1) const { return wide_ ? x.dot(t_c1) : t_c1.z(); }
  /// Effect of the translation on the place of a ray: parallaxDirection of any kind of rays.
  Eigen::Vector3d parallax(const Eigen::Vector3d& x, const Eigen::Vector3d& t_c1) const {
    return t_c1 - x * along(x, t_c1);
  }

  double focal_px_;
  bool wide_;
  Eigen::Vector3d t_c1_ = Eigen::Vector3d::Zero();
  int epoch_ = 0;
  double typical_ = 0;
  std::map<TrackId, InverseDepth> points_;
};

/// Effect of the camera's translation on a point at `x` (turned into the new frame, normalised): its image moves by
/// w / (1 + w t_z) times this.
inline Eigen::Vector2d parallaxDirection(const Eigen::Vector2d& x, const Eigen::Vector3d& t_c1) {
  return t_c1.head<2>() - x * t_c1.z();
}

/// Inverse depth in the new frame of what has inverse depth `w` in the turned old one.
/// `along_c1`: the depth that the translation adds, t_z.
inline double carriedInverseDepth(double w, double along_c1) { return w / std::max(1 + w * along_c1, 0.2); }

}  // namespace lintel
