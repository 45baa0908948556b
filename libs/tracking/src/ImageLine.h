// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "ImageMask.h"
#include "lintel/geometry/Camera.h"

namespace lintel {

/// A segment in undistorted pixels: of the image of a pinhole camera with the mean focal length in the same place,
/// origin at its optical axis. Straight edges are straight here, and distances are pixels. That camera looks where the
/// real one does, or, where the lens is wide, at the line: its plane is tangent to the sphere of rays near the line's
/// middle, so that a pixel is nearly a pixel of the real image wherever the line is. Lines with different axes are
/// compared after LineCamera::seenFrom().
struct ImageLine {
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< where that camera looks, in the real one's frame

  double length() const { return (end - start).norm(); }
  Eigen::Vector2d direction() const { return (end - start).normalized(); }
  /// Direction turned by +90 degrees (x right, y down: to the right hand of one who walks from start to end).
  Eigen::Vector2d normal() const {
    const Eigen::Vector2d d = direction();
    return {-d.y(), d.x()};
  }
  Eigen::Vector2d at(double share) const { return start + share * (end - start); }
};

/// How two segments lie to each other.
struct LineRelation {
  double angle_rad;    ///< between the directions, signed ends count: in [0, pi]
  double distance_px;  ///< larger distance of the second one's ends from the first one's infinite line
  double overlap_px;   ///< of the projections on the first line; negative: the gap between them
};
LineRelation relate(const ImageLine& line, const ImageLine& other);

/// Conversions between undistorted pixels and the image.
class LineCamera {
 public:
  explicit LineCamera(const Camera& camera, const ImageMask& mask = {});

  double focal() const { return focal_; }
  /// A length that stands for an angle, given in pixels at the reference focal length (core/ParamRange.h), in pixels of
  /// this camera.
  double scaled(double reference_px) const { return pixel_scale_ * reference_px; }
  const Camera& camera() const { return camera_; }
  const ImageMask& mask() const { return mask_; }
  /// Whether a pixel is in the image, at least `border_px` from its edge, and used.
  bool uses(const Eigen::Vector2d& px, double border_px) const {
    return camera_.contains(px, border_px) && !mask_.covers(px);
  }

  // `axis`: of the line to which the undistorted pixel belongs.

  Eigen::Vector2d fromImage(const Eigen::Vector2d& px, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) const {
    return camera_.wide() ? ofRay(camera_.ray(px), axis) : focal_ * camera_.normalise(px);
  }
  Eigen::Vector2d toImage(const Eigen::Vector2d& u, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) const {
    return camera_.wide() ? camera_.project(rayOf(u, axis)) : camera_.toPixel(u / focal_);
  }
  /// The ray (Camera.h) of an undistorted pixel.
  Eigen::Vector3d rayOf(const Eigen::Vector2d& u, const Eigen::Vector3d& axis) const;
  /// The line between two pixels of the image, with the axis of its middle.
  ImageLine lineFromImage(const Eigen::Vector2d& start_px, const Eigen::Vector2d& end_px) const;
  /// d image pixel / d undistorted pixel.
  Eigen::Matrix2d imageJacobian(const Eigen::Vector2d& u, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) const;
  /// As toImage; empty so far out that the lens model folds back into the image, or that the plane is stretched.
  std::optional<Eigen::Vector2d> seenAt(const Eigen::Vector2d& u,
                                        const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) const;
  /// Seen in the used part of the image, at least `border_px` from its edge.
  bool sees(const Eigen::Vector2d& u, double border_px, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) const;
  /// The part of `line` that the image sees; empty when there is none.
  std::optional<ImageLine> clip(const ImageLine& line, double border_px) const;
  /// Where `line` of the camera c0 would be seen in c1 had the camera only turned; with the axis of its middle there.
  ImageLine turned(const ImageLine& line, const Eigen::Quaterniond& R_c1_c0) const;
  /// The same line with another axis.
  ImageLine seenFrom(const Eigen::Vector3d& axis, const ImageLine& line) const;
  /// The same line with the axis of its middle.
  ImageLine centred(const ImageLine& line) const;
  /// relate() with lines of any axes, in the plane of the first one's; quick where the second one is farther than
  /// `most_px` from the first, and empty there.
  std::optional<LineRelation> relateNear(const ImageLine& line, const ImageLine& other, double most_px) const;
  /// Rotation from the frame of a line's own camera to the real one's.
  static Eigen::Matrix3d R_c_a(const Eigen::Vector3d& axis);

 private:
  bool mayBeNear(const ImageLine& line, const ImageLine& other, double most_px) const;
  Eigen::Vector2d ofRay(const Eigen::Vector3d& ray, const Eigen::Vector3d& axis) const;
  ImageLine between(const Eigen::Vector3d& start_ray, const Eigen::Vector3d& end_ray) const;

  Camera camera_;
  ImageMask mask_;
  double focal_;
  double pixel_scale_;
  double max_radius_ = 0;    ///< of undistorted pixels in the image, with a little room
  double least_cosine_ = 0;  ///< of the angle to the optical axis, of what a wide image shows
};

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
