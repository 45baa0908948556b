// SPDX-License-Identifier: BSD-3-Clause
#include "ImageLine.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/ParamRange.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {
namespace {

/// Through the centroid along the strongest direction of scatter; direction kept towards `hint`.
void totalLeastSquares(const std::vector<Eigen::Vector2d>& points, RobustLine& fit) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.inlier[i]) mean += points[i] / fit.inliers;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.inlier[i]) scatter += (points[i] - mean) * (points[i] - mean).transpose();
  const Eigen::Vector2d d = symmetricEigen(scatter).vectors.col(1);
  std::size_t first = 0, last = points.size() - 1;
  while (!fit.inlier[first]) ++first;
  while (!fit.inlier[last]) --last;
  fit.line.start = mean + d * d.dot(points[first] - mean);
  fit.line.end = mean + d * d.dot(points[last] - mean);
}

constexpr double kBehind = -0.999;    ///< z of an axis that looks back: the least rotation to it is not defined
constexpr double kLeastDepth = 0.1;   ///< of a ray along an axis: farther to the side the plane is stretched too much
constexpr double kMostStretch = 1.4;  ///< tangent of the angle between a line's axis and its ends: 54 degrees
constexpr double kRoom = 1.02;

// R_c_a and its transpose times a vector, without the matrix: they are most of what a line through a wide lens costs.

Eigen::Vector3d fromLineCamera(const Eigen::Vector3d& axis, const Eigen::Vector3d& v) {
  const double along = axis.x() * v.x() + axis.y() * v.y(), c = v.z() - along / (1 + std::max(axis.z(), kBehind));
  return {v.x() + axis.x() * c, v.y() + axis.y() * c, axis.z() * v.z() - along};
}

Eigen::Vector3d toLineCamera(const Eigen::Vector3d& axis, const Eigen::Vector3d& v) {
  const double along = axis.x() * v.x() + axis.y() * v.y(), c = v.z() + along / (1 + std::max(axis.z(), kBehind));
  return {v.x() - axis.x() * c, v.y() - axis.y() * c, axis.z() * v.z() + along};
}

}  // namespace

LineCamera::LineCamera(const Camera& camera, const ImageMask& mask)
    : camera_(camera), mask_(mask), focal_(camera.meanFocal()), pixel_scale_(pixelScale(camera)) {
  if (camera.wide()) {
    least_cosine_ = std::cos(std::min(kRoom * largestAngle(camera), 3.14));
    return;
  }
  for (const double x : {0.0, camera.width - 1.0})
    for (const double y : {0.0, camera.height - 1.0})
      max_radius_ = std::max(max_radius_, kRoom * fromImage({x, y}).norm());
}

Eigen::Matrix3d LineCamera::R_c_a(const Eigen::Vector3d& a) {
  // the least rotation from the optical axis: x and y stay x and y where possible
  const double c = 1 / (1 + std::max(a.z(), kBehind));
  Eigen::Matrix3d R;
  R << 1 - a.x() * a.x() * c, -a.x() * a.y() * c, a.x(), -a.x() * a.y() * c, 1 - a.y() * a.y() * c, a.y(), -a.x(),
      -a.y(), a.z();
  return R;
}

Eigen::Vector3d LineCamera::rayOf(const Eigen::Vector2d& u, const Eigen::Vector3d& axis) const {
  const Eigen::Vector3d ray = (u / focal_).homogeneous();
  return camera_.wide() ? fromLineCamera(axis, ray).normalized() : ray;
}

Eigen::Vector2d LineCamera::ofRay(const Eigen::Vector3d& ray, const Eigen::Vector3d& axis) const {
  const Eigen::Vector3d seen = toLineCamera(axis, ray);
  return focal_ * seen.head<2>() / std::max(seen.z(), kLeastDepth);
}

ImageLine LineCamera::between(const Eigen::Vector3d& start_ray, const Eigen::Vector3d& end_ray) const {
  const Eigen::Vector3d axis = (start_ray + end_ray).normalized();
  return {ofRay(start_ray, axis), ofRay(end_ray, axis), axis};
}

ImageLine LineCamera::lineFromImage(const Eigen::Vector2d& start_px, const Eigen::Vector2d& end_px) const {
  if (camera_.wide()) return between(camera_.ray(start_px), camera_.ray(end_px));
  return {fromImage(start_px), fromImage(end_px)};
}

ImageLine LineCamera::seenFrom(const Eigen::Vector3d& axis, const ImageLine& line) const {
  if (!camera_.wide() || axis == line.axis) return line;
  return {ofRay(rayOf(line.start, line.axis), axis), ofRay(rayOf(line.end, line.axis), axis), axis};
}

ImageLine LineCamera::centred(const ImageLine& line) const {
  return camera_.wide() ? between(rayOf(line.start, line.axis), rayOf(line.end, line.axis)) : line;
}

/// Whether a line of any axis may be nearer than `most_px` to another one: the axis of the second one, which is on it,
/// from the great circle of the first.
bool LineCamera::mayBeNear(const ImageLine& line, const ImageLine& other, double most_px) const {
  const Eigen::Vector3d normal = (line.start / focal_).homogeneous().cross((line.end / focal_).homogeneous());
  const double reach = most_px + 0.1 * other.length(),
               across = focal_ * normal.dot(toLineCamera(line.axis, other.axis));
  return across * across <= reach * reach * normal.squaredNorm();
}

std::optional<LineRelation> LineCamera::relateNear(const ImageLine& line, const ImageLine& other,
                                                   double most_px) const {
  if (camera_.wide() && !(line.axis == other.axis)) {
    if (!mayBeNear(line, other, most_px)) return std::nullopt;
    return relateNear(line, seenFrom(line.axis, other), most_px);
  }
  const Eigen::Vector2d along = line.end - line.start, from = other.start - line.start;
  const double across = along.x() * from.y() - along.y() * from.x();
  if (across * across > most_px * most_px * along.squaredNorm()) return std::nullopt;
  const LineRelation relation = relate(line, other);
  if (relation.distance_px > most_px) return std::nullopt;
  return relation;
}

std::optional<Eigen::Vector2d> LineCamera::seenAt(const Eigen::Vector2d& u, const Eigen::Vector3d& axis) const {
  if (!camera_.wide()) {
    if (u.squaredNorm() > max_radius_ * max_radius_) return std::nullopt;
    return camera_.toPixel(u / focal_);
  }
  if (u.squaredNorm() > kMostStretch * kMostStretch * focal_ * focal_) return std::nullopt;
  const Eigen::Vector3d direction = fromLineCamera(axis, (u / focal_).homogeneous());
  if (direction.z() < least_cosine_ * direction.norm()) return std::nullopt;
  return camera_.project(direction);
}

Eigen::Matrix2d LineCamera::imageJacobian(const Eigen::Vector2d& u, const Eigen::Vector3d& axis) const {
  if (camera_.wide()) {
    PixelJacobians d;
    const Eigen::Matrix3d R = R_c_a(axis);
    camera_.project(R * (u / focal_).homogeneous(), 1, d);
    return d.point * R.leftCols<2>() / focal_;
  }
  Eigen::Matrix2d J = camera_.distortJacobian(u / focal_) / focal_;
  J.row(0) *= camera_.fx;
  J.row(1) *= camera_.fy;
  return J;
}

ImageLine LineCamera::turned(const ImageLine& line, const Eigen::Quaterniond& R_c1_c0) const {
  if (camera_.wide()) return between(R_c1_c0 * rayOf(line.start, line.axis), R_c1_c0 * rayOf(line.end, line.axis));
  // Ends may lie outside the image, where the lens model folds back: they stay in undistorted pixels.
  const auto turn = [&](const Eigen::Vector2d& u) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = R_c1_c0 * (u / focal_).homogeneous();
    return focal_ * ray.head<2>() / std::max(ray.z(), 0.1);
  };
  return {turn(line.start), turn(line.end)};
}

bool LineCamera::sees(const Eigen::Vector2d& u, double border_px, const Eigen::Vector3d& axis) const {
  const auto px = seenAt(u, axis);
  return px && uses(*px, border_px);
}

std::optional<ImageLine> LineCamera::clip(const ImageLine& line, double border_px) const {
  constexpr int kSteps = 16;  // the part in the image is looked for in such pieces; a lens bends it little
  const auto seen = [&](double share) { return sees(line.at(share), border_px, line.axis); };
  int first = 0, last = kSteps;
  while (first <= kSteps && !seen(static_cast<double>(first) / kSteps)) ++first;
  if (first > kSteps) return std::nullopt;
  while (!seen(static_cast<double>(last) / kSteps)) --last;
  // The border lies between a seen and an unseen step.
  const auto bisect = [&](double in, double out) {
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (in + out);
      (seen(middle) ? in : out) = middle;
    }
    return in;
  };
  const double s0 =
      first == 0 ? 0.0 : bisect(static_cast<double>(first) / kSteps, static_cast<double>(first - 1) / kSteps);
  const double s1 =
      last == kSteps ? 1.0 : bisect(static_cast<double>(last) / kSteps, static_cast<double>(last + 1) / kSteps);
  return ImageLine{line.at(s0), line.at(s1), line.axis};
}

LineRelation relate(const ImageLine& line, const ImageLine& other) {
  const Eigen::Vector2d d = line.direction(), n = line.normal(), e = other.direction();
  const double s0 = d.dot(other.start - line.start), s1 = d.dot(other.end - line.start);
  LineRelation relation;
  relation.angle_rad = std::abs(std::atan2(d.x() * e.y() - d.y() * e.x(), d.dot(e)));
  relation.distance_px = std::max(std::abs(n.dot(other.start - line.start)), std::abs(n.dot(other.end - line.start)));
  relation.overlap_px = std::min(line.length(), std::max(s0, s1)) - std::max(0.0, std::min(s0, s1));
  return relation;
}

std::optional<RobustLine> fitRobustLine(const std::vector<Eigen::Vector2d>& points, double tolerance_px) {
  RobustLine best;
  double best_cost = 1e18;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const ImageLine line{points[i], points[j]};
      if (line.length() < 4 * tolerance_px) continue;
      const Eigen::Vector2d n = line.normal();
      double cost = 0;
      for (const Eigen::Vector2d& p : points) cost += std::min(std::abs(n.dot(p - points[i])) / tolerance_px, 1.0);
      if (cost >= best_cost) continue;
      best_cost = cost;
      best.line = line;
    }
  if (best_cost > 1e17) return std::nullopt;
  for (int round = 0; round < 2; ++round) {
    const Eigen::Vector2d n = best.line.normal();
    best.inlier.assign(points.size(), 0);
    best.inliers = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      best.inlier[i] = std::abs(n.dot(points[i] - best.line.start)) < tolerance_px ? 1 : 0;
      best.inliers += best.inlier[i];
    }
    if (best.inliers < 3 || 2 * best.inliers < static_cast<int>(points.size())) return std::nullopt;
    totalLeastSquares(points, best);
    if (best.line.length() < 1e-6) return std::nullopt;
  }
  return best;
}

}  // namespace lintel
