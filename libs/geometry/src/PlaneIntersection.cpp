// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/PlaneIntersection.h"

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

/// The direction that is perpendicular to all normals; empty when more than one is.
std::optional<Eigen::Vector3d> commonDirection(const std::vector<ObservationPlane>& planes) {
  constexpr double kParallel = 1e-12;  // squared sine of the angle between the planes
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (const ObservationPlane& plane : planes) normals += plane.normal_w * plane.normal_w.transpose();
  const SymmetricEigen<3> eigen = symmetricEigen(normals);
  if (eigen.values[1] < kParallel) return std::nullopt;
  return eigen.vectors.col(0);
}

}  // namespace

std::optional<LineThroughPoint> intersectPlanes(const std::vector<ObservationPlane>& planes,
                                                const Eigen::Vector3d& anchor_w, const LineConstraints& constraints) {
  const std::optional<Eigen::Vector3d> direction =
      constraints.direction_w ? constraints.direction_w : commonDirection(planes);
  if (!direction) return std::nullopt;
  const Eigen::Vector3d& d = *direction;
  const Eigen::Matrix3d along = d * d.transpose();
  Eigen::Matrix3d A = along;
  Eigen::Vector3d b = d * d.dot(anchor_w);
  for (const ObservationPlane& plane : planes) {
    A += plane.normal_w * plane.normal_w.transpose();
    b += plane.normal_w * plane.normal_w.dot(plane.centre_w);
  }
  for (const Eigen::Vector3d& p_w : constraints.points_w) {
    A += Eigen::Matrix3d::Identity() - along;
    b += p_w - d * d.dot(p_w);
  }
  const Eigen::Vector3d point_w = solveLdlt(A, b);
  if (!point_w.allFinite()) return std::nullopt;
  return LineThroughPoint{point_w, d};
}

}  // namespace lintel
