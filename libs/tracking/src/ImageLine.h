// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "lintel/geometry/PinholeRadtan.h"

namespace lintel {

/// A segment in undistorted pixels: normalised coordinates times the mean focal length, origin at the optical axis.
/// Straight edges are straight here, and distances are pixels.
struct ImageLine {
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();

  double length() const { return (end - start).norm(); }
  Eigen::Vector2d direction() const { return (end - start).normalized(); }
  /// Direction turned by +90 degrees (x right, y down: to the right hand of one who walks from start to end).
  Eigen::Vector2d normal() const {
    const Eigen::Vector2d d = direction();
    return {-d.y(), d.x()};
  }
  Eigen::Vector2d at(double share) const { return start + share * (end - start); }
};

/// Conversions between undistorted pixels and the image.
class LineCamera {
 public:
  explicit LineCamera(const PinholeRadtan& camera);

  double focal() const { return focal_; }
  const PinholeRadtan& camera() const { return camera_; }

  Eigen::Vector2d fromImage(const Eigen::Vector2d& px) const { return focal_ * camera_.normalise(px); }
  Eigen::Vector2d toImage(const Eigen::Vector2d& u) const { return camera_.toPixel(u / focal_); }
  /// d image pixel / d undistorted pixel.
  Eigen::Matrix2d imageJacobian(const Eigen::Vector2d& u) const;
  /// Not so far out that the lens model folds back into the image.
  bool mayBeSeen(const Eigen::Vector2d& u) const { return u.squaredNorm() <= max_radius_ * max_radius_; }
  /// Seen in the image, at least `border_px` from its edge.
  bool sees(const Eigen::Vector2d& u, double border_px) const;
  /// The part of `line` that the image sees; empty when there is none.
  std::optional<ImageLine> clip(const ImageLine& line, double border_px) const;

 private:
  PinholeRadtan camera_;
  double focal_;
  double max_radius_;  ///< of undistorted pixels in the image, with a little room
};

/// How two segments lie to each other.
struct LineRelation {
  double angle_rad;    ///< between the directions, signed ends count: in [0, pi]
  double distance_px;  ///< larger distance of the second one's ends from the first one's infinite line
  double overlap_px;   ///< of the projections on the first line; negative: the gap between them
};
LineRelation relate(const ImageLine& line, const ImageLine& other);

}  // namespace lintel
