// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace lintel {

/// A plane through a camera's centre and a line as that camera saw it.
struct ObservationPlane {
  Eigen::Vector3d normal_w, centre_w;  ///< the normal a unit vector
};

/// A line through `point_w` along the unit vector `direction_w`.
struct LineThroughPoint {
  Eigen::Vector3d point_w, direction_w;
};

/// What a line is known to fulfil beside its planes.
struct LineConstraints {
  std::optional<Eigen::Vector3d> direction_w;  ///< unit
  std::vector<Eigen::Vector3d> points_w;       ///< that lie on it
};

/// The line in which planes intersect, in the least-squares sense, for any number of them [Lim2021, eq. make_plane]:
/// its direction is what all normals are perpendicular to; its point is the one nearest to all planes, abreast of
/// `anchor_w`. Empty when the planes coincide and no direction is given.
std::optional<LineThroughPoint> intersectPlanes(const std::vector<ObservationPlane>& planes,
                                                const Eigen::Vector3d& anchor_w,
                                                const LineConstraints& constraints = {});

}  // namespace lintel
