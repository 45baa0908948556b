// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/ImageObservations.h"

#include <Eigen/LU>
#include <algorithm>

namespace lintel {

namespace {

NormalisedObservation linearised(const PinholeRadtan& camera, const Eigen::Vector2d& normalised) {
  NormalisedObservation o;
  o.position = normalised;
  const Eigen::Vector2d distorted = camera.distort(normalised);
  const double r2 = normalised.squaredNorm();
  // distort(x) = (px - c) / f: both sides differentiated
  Eigen::Matrix<double, 2, 6> d_distorted;
  d_distorted << -distorted.x() / camera.fx, 0, -1 / camera.fx, 0, -normalised.x() * r2, -normalised.x() * r2 * r2, 0,
      -distorted.y() / camera.fy, 0, -1 / camera.fy, -normalised.y() * r2, -normalised.y() * r2 * r2;
  o.correction_jacobian.leftCols<6>() = camera.distortJacobian(normalised).inverse() * d_distorted;
  return o;
}

/// How the Jacobian of the distortion at an observation, of a fixed pixel, moves with component `k` of the correction:
/// directly (k1 k2), and because the observation moves. Differences of a smooth function, exact to 1e-8.
Eigen::Matrix2d distortJacobianChange(const PinholeRadtan& camera, const NormalisedObservation& o, int k) {
  constexpr double kStep = 1e-4;
  const auto jacobian = [&](double by) {
    PinholeRadtan moved = camera;
    if (k == 4) moved.k1 += by;
    if (k == 5) moved.k2 += by;
    return moved.distortJacobian(o.position + by * o.correction_jacobian.col(k));
  };
  const double unit = std::max(1.0, o.correction_jacobian.col(k).norm());
  const double step = kStep / unit;
  return (jacobian(step) - jacobian(-step)) / (2 * step);
}

/// With J = d pixel / d normalised and the unit normal n of a line, a distance h across it is h / |J^-T n| pixels.
LineEnd makeLineEnd(const PinholeRadtan& camera, const Eigen::Vector2d& normalised, const Eigen::Vector2d& normal) {
  LineEnd end;
  static_cast<NormalisedObservation&>(end) = linearised(camera, normalised);
  const Eigen::DiagonalMatrix<double, 2> F(camera.fx, camera.fy);
  const Eigen::Matrix2d D = camera.distortJacobian(normalised), J_inverse = (F * D).inverse();
  const Eigen::Vector2d v = J_inverse.transpose() * normal, w = J_inverse * v;
  end.linearised_scale_px = 1 / v.norm();
  for (int k = 0; k < kTimeOffsetAt; ++k) {
    Eigen::Matrix2d dJ = F * distortJacobianChange(camera, end, k);
    if (k < 2) dJ.row(k) += D.row(k);  // fx fy
    end.log_scale_jacobian[k] = v.dot(dJ * w) / v.squaredNorm();
  }
  return end;
}

}  // namespace

NormalisedObservation makeObservation(const PinholeRadtan& calibrated, const Eigen::Vector2d& px,
                                      const CorrectionBlock& correction) {
  const PinholeRadtan camera = correctedCamera(calibrated, correction.data());
  NormalisedObservation o = linearised(camera, camera.normalise(px));
  o.linearised_at = correction;
  return o;
}

std::pair<LineEnd, LineEnd> makeLineEnds(const PinholeRadtan& calibrated, const Eigen::Vector2d& start_px,
                                         const Eigen::Vector2d& end_px, const CorrectionBlock& correction) {
  const PinholeRadtan camera = correctedCamera(calibrated, correction.data());
  const Eigen::Vector2d start = camera.normalise(start_px), end = camera.normalise(end_px);
  const Eigen::Vector2d along = (end - start).normalized(), normal(-along.y(), along.x());
  std::pair<LineEnd, LineEnd> ends{makeLineEnd(camera, start, normal), makeLineEnd(camera, end, normal)};
  ends.first.linearised_at = ends.second.linearised_at = correction;
  return ends;
}

}  // namespace lintel
