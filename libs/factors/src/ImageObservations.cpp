// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/ImageObservations.h"

#include <Eigen/LU>
#include <algorithm>

#include "lintel/factors/EdgeFit.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

RayObservation linearised(const Camera& camera, const Eigen::Vector2d& normalised) {
  RayObservation o;
  o.ray = normalised.homogeneous();
  const Eigen::Vector2d distorted = camera.distort(normalised);
  // distort(x) = (px - c) / f: both sides differentiated
  Eigen::Matrix<double, 2, kIntrinsicsSize> d_distorted;
  d_distorted.leftCols<4>() << -distorted.x() / camera.fx, 0, -1 / camera.fx, 0, 0, -distorted.y() / camera.fy, 0,
      -1 / camera.fy;
  d_distorted.rightCols<2>() = -camera.coefficientJacobian(normalised);
  o.correction_jacobian = camera.distortJacobian(normalised).inverse() * d_distorted;
  return o;
}

/// How the Jacobian of the distortion at an observation, of a fixed pixel, moves with the correction: directly (k1 k2),
/// and because the observation moves. Differences of a smooth function, exact to 1e-8.
class DistortJacobianChange {
 public:
  DistortJacobianChange(const Camera& camera, const RayObservation& o) : by_correction_(o.correction_jacobian) {
    constexpr double kStep = 1e-4;
    const Eigen::Vector2d at = o.ray.head<2>();
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
      by_place_[i] = (camera.distortJacobian(at + step) - camera.distortJacobian(at - step)) / (2 * kStep);
      Camera more = camera, less = camera;
      more.lens[static_cast<std::size_t>(i)] += kStep;
      less.lens[static_cast<std::size_t>(i)] -= kStep;
      by_lens_[i] = (more.distortJacobian(at) - less.distortJacobian(at)) / (2 * kStep);
    }
  }

  /// With component `k`.
  Eigen::Matrix2d by(int k) const {
    Eigen::Matrix2d change = by_correction_(0, k) * by_place_[0] + by_correction_(1, k) * by_place_[1];
    if (k >= 4) change += by_lens_[k - 4];
    return change;
  }

 private:
  const ObservationJacobian& by_correction_;
  Eigen::Matrix2d by_place_[2], by_lens_[2];
};

/// With J = d pixel / d normalised and the unit normal n of a line, a distance h across it is h / |J^-T n| pixels.
LineEnd makeLineEnd(const Camera& camera, const Eigen::Vector2d& normalised, const Eigen::Vector2d& normal) {
  LineEnd end;
  static_cast<RayObservation&>(end) = linearised(camera, normalised);
  const Eigen::DiagonalMatrix<double, 2> F(camera.fx, camera.fy);
  const Eigen::Matrix2d D = camera.distortJacobian(normalised), J_inverse = (F * D).inverse();
  const Eigen::Vector2d v = J_inverse.transpose() * normal, w = J_inverse * v;
  end.linearised_scale_px = 1 / v.norm();
  const DistortJacobianChange change(camera, end);
  for (int k = 0; k < kIntrinsicsSize; ++k) {
    Eigen::Matrix2d dJ = F * change.by(k);
    if (k < 2) dJ.row(k) += D.row(k);  // fx fy
    end.log_scale_jacobian[k] = v.dot(dJ * w) / v.squaredNorm();
  }
  return end;
}

/// d pixel / d (along, across) at a unit ray, across being `normal` of a great circle through the ray.
Eigen::Matrix2d tangentJacobian(const Camera& camera, const Eigen::Vector3d& ray, const Eigen::Vector3d& normal) {
  PixelJacobians d;
  camera.project(ray, 1, d);
  const Eigen::Vector3d across = (normal - normal.dot(ray) * ray).normalized();
  Eigen::Matrix2d J;
  J << d.point * across.cross(ray), d.point * across;
  return J;
}

RayObservation wideObservation(const Camera& camera, const Eigen::Vector3d& ray) {
  RayObservation o;
  o.wide = true;
  o.ray = ray;
  PixelJacobians d;
  camera.project(ray, 1, d);
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(ray);
  // of a fixed pixel: d.point B dray + d.intrinsics dc = 0
  const Eigen::Matrix<double, 3, kIntrinsicsSize> J = -B * (d.point * B).inverse() * d.intrinsics;
  o.correction_jacobian = J.topRows<2>();
  o.z_jacobian = J.bottomRows<1>();
  return o;
}

/// Pixels of a distance of 1 across the line at `ray`: as in makeLineEnd, in the plane tangent to the sphere there.
double wideScale_px(const Camera& camera, const Eigen::Vector3d& ray, const Eigen::Vector3d& normal) {
  const Eigen::Vector2d across = tangentJacobian(camera, ray, normal).inverse().transpose() * Eigen::Vector2d::UnitY();
  return 1 / across.norm();
}

// A tracked line is the straight line that fits an edge best, as straight as the *calibrated* camera has it. Through a
// corrected camera the edge is another curve, and the line that fits it best does not end at the same pixels: all of
// the edge moves it. Taken at its ends alone, an observation would be biased towards the calibrated camera, more than
// by the noise where a lens bends edges strongly. So the edge is sampled along the calibrated camera's line, and the
// ends are those of the line that fits the samples best.

/// Moves an end across its line, to where the fit has it, and its Jacobian with it. `across`: unit, across the line;
/// `offset`, `offset_jacobian`: of the fit's end from the present one along `across`, per row of the ray.
void moveEnd(LineEnd& end, const Eigen::Vector3d& across, double offset, const RayObservation::Row& offset_jacobian) {
  end.ray += offset * across;
  const RayObservation::Row change =
      offset_jacobian - across.head<2>().transpose() * end.correction_jacobian - across.z() * end.z_jacobian;
  end.correction_jacobian += across.head<2>() * change;
  if (!end.wide) return;
  end.z_jacobian += across.z() * change;
  end.ray.normalize();
}

/// d (across . ray) / d intrinsics.
RayObservation::Row acrossJacobian(const RayObservation& o, const Eigen::Vector3d& across) {
  RayObservation::Row J = across.head<2>().transpose() * o.correction_jacobian;
  if (o.wide) J += across.z() * o.z_jacobian;
  return J;
}

/// The end at `ray` of a line that ends at `other` as well.
LineEnd wideLineEnd(const Camera& camera, const Eigen::Vector3d& ray, const Eigen::Vector3d& other) {
  constexpr double kStep = 1e-5;  // of the intrinsics, as an angle: differences of a smooth function, exact to 1e-9
  LineEnd end;
  static_cast<RayObservation&>(end) = wideObservation(camera, ray);
  end.linearised_scale_px = wideScale_px(camera, ray, ray.cross(other));
  const RayObservation other_end = wideObservation(camera, other);
  const auto jacobian = [](const RayObservation& o, int k) {
    return Eigen::Vector3d(o.correction_jacobian(0, k), o.correction_jacobian(1, k), o.z_jacobian[k]);
  };
  for (int k = 0; k < kIntrinsicsSize; ++k) {
    const Eigen::Vector3d J = jacobian(end, k), J_other = jacobian(other_end, k);
    const double step = kStep / std::max({J.norm(), J_other.norm(), 1e-4});
    const auto scale = [&](double by) {
      Camera moved = camera;
      moved.intrinsic(k) += by;
      const Eigen::Vector3d at = (ray + by * J).normalized();
      return wideScale_px(moved, at, at.cross(other + by * J_other));
    };
    end.log_scale_jacobian[k] = (scale(step) - scale(-step)) / (2 * step * end.linearised_scale_px);
  }
  return end;
}

/// Moves the ends to those of the line that fits the edge best. Offsets are taken in the plane that touches the sphere
/// in the line's middle, where the front end fits.
void fitWideEnds(const Camera& calibrated, const Camera& camera, const Eigen::Vector2d& start_px,
                 const Eigen::Vector2d& end_px, std::pair<LineEnd, LineEnd>& ends) {
  const Eigen::Vector3d a = calibrated.ray(start_px), b = calibrated.ray(end_px);
  const Eigen::Vector3d middle = (a + b).normalized(), along = (b - a) / 2 / middle.dot(a);
  const Eigen::Vector3d to = (ends.first.ray + ends.second.ray).normalized();
  const Eigen::Vector3d across = ends.first.ray.cross(ends.second.ray).normalized();
  RayObservation samples[EdgeFit::kSamples];
  for (int i = 0; i < EdgeFit::kSamples; ++i)
    samples[i] = wideObservation(camera, camera.ray(calibrated.project(middle + EdgeFit::kNodes[i] * along)));
  for (LineEnd* end : {&ends.first, &ends.second}) {
    const double side = end == &ends.first ? -1 : 1, scale = to.dot(end->ray);
    double offset = 0;
    RayObservation::Row J = RayObservation::Row::Zero();
    for (int i = 0; i < EdgeFit::kSamples; ++i) {
      const double share = EdgeFit::share(i, side) * scale / to.dot(samples[i].ray);
      offset += share * across.dot(samples[i].ray);
      J += share * acrossJacobian(samples[i], across);
    }
    moveEnd(*end, across, offset, J);
  }
}

/// The same on the plane z = 1. `a`, `b`: the ends as the calibrated camera sees them.
void fitEnds(const Camera& calibrated, const Camera& camera, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
             const Eigen::Vector2d& normal, std::pair<LineEnd, LineEnd>& ends) {
  const Eigen::Vector3d across(normal.x(), normal.y(), 0);
  const double line = across.dot(ends.first.ray);
  RayObservation samples[EdgeFit::kSamples];
  for (int i = 0; i < EdgeFit::kSamples; ++i) {
    const Eigen::Vector2d at = (a + b) / 2 + EdgeFit::kNodes[i] * (b - a) / 2;
    samples[i] = linearised(camera, camera.normalise(calibrated.project(at.homogeneous()), at));
  }
  for (LineEnd* end : {&ends.first, &ends.second}) {
    double offset = -line;
    RayObservation::Row J = RayObservation::Row::Zero();
    for (int i = 0; i < EdgeFit::kSamples; ++i) {
      const double share = EdgeFit::share(i, end == &ends.first ? -1 : 1);
      offset += share * across.dot(samples[i].ray);
      J += share * acrossJacobian(samples[i], across);
    }
    moveEnd(*end, across, offset, J);
  }
}

}  // namespace

Eigen::Vector3d RayObservation::corrected(const double* correction) const {
  const IntrinsicsBlock change = intrinsicsOf(correction) - linearised_at;
  Eigen::Vector3d moved = ray;
  moved.head<2>() += correction_jacobian * change;
  if (wide) moved.z() += z_jacobian.dot(change);
  return moved;
}

RayObservation::Row RayObservation::alongJacobian(const Eigen::Vector3d& v) const {
  Row J = v.head<2>().transpose() * correction_jacobian;
  if (wide) J += v.z() * z_jacobian;
  return J;
}

double LineEnd::scale_px(const double* correction) const {
  return linearised_scale_px * (1 + log_scale_jacobian.dot(intrinsicsOf(correction) - linearised_at));
}

RayObservation makeObservation(const Camera& calibrated, const Eigen::Vector2d& px, const CorrectionBlock& correction) {
  const Camera camera = correctedCamera(calibrated, correction.data());
  RayObservation o = camera.wide() ? wideObservation(camera, camera.ray(px)) : linearised(camera, camera.normalise(px));
  o.linearised_at = intrinsicsOf(correction.data());
  return o;
}

std::pair<LineEnd, LineEnd> makeLineEnds(const Camera& calibrated, const Eigen::Vector2d& start_px,
                                         const Eigen::Vector2d& end_px, const CorrectionBlock& correction) {
  const Camera camera = correctedCamera(calibrated, correction.data());
  if (camera.wide()) {
    const Eigen::Vector3d start = camera.ray(start_px), end = camera.ray(end_px);
    std::pair<LineEnd, LineEnd> ends{wideLineEnd(camera, start, end), wideLineEnd(camera, end, start)};
    fitWideEnds(calibrated, camera, start_px, end_px, ends);
    ends.first.linearised_at = ends.second.linearised_at = intrinsicsOf(correction.data());
    return ends;
  }
  const Eigen::Vector2d a = calibrated.normalise(start_px), b = calibrated.normalise(end_px);
  const Eigen::Vector2d start = camera.normalise(start_px, a), end = camera.normalise(end_px, b);
  const Eigen::Vector2d along = (end - start).normalized(), normal(-along.y(), along.x());
  std::pair<LineEnd, LineEnd> ends{makeLineEnd(camera, start, normal), makeLineEnd(camera, end, normal)};
  fitEnds(calibrated, camera, a, b, normal, ends);
  ends.first.linearised_at = ends.second.linearised_at = intrinsicsOf(correction.data());
  return ends;
}

}  // namespace lintel
