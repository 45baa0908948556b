// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

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
  /// A length that stands for an angle, given in pixels at the reference focal length (core/ParamRange.h), in pixels of
  /// this camera.
  double scaled(double reference_px) const { return pixel_scale_ * reference_px; }
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
  /// Where `line` of the camera c0 would be seen in c1 had the camera only turned.
  ImageLine turned(const ImageLine& line, const Eigen::Quaterniond& R_c1_c0) const;

 private:
  PinholeRadtan camera_;
  double focal_;
  double pixel_scale_;
  double max_radius_ = 0;  ///< of undistorted pixels in the image, with a little room
};

/// How two segments lie to each other.
struct LineRelation {
  double angle_rad;    ///< between the directions, signed ends count: in [0, pi]
  double distance_px;  ///< larger distance of the second one's ends from the first one's infinite line
  double overlap_px;   ///< of the projections on the first line; negative: the gap between them
};
LineRelation relate(const ImageLine& line, const ImageLine& other);

/// A line fitted to points some of which are wrong.
struct RobustLine {
  ImageLine line;            ///< through the first and last inlier
  std::vector<char> inlier;  ///< per point
  int inliers = 0;
};

/// The line that most points lie on (every pair is tried: meant for about ten points), refitted by total least squares.
/// Empty with fewer than 3 inliers or less than half of the points.
std::optional<RobustLine> fitRobustLine(const std::vector<Eigen::Vector2d>& points, double tolerance_px);

}  // namespace lintel
