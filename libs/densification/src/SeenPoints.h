// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "SegmentView.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Which views see which points of the map, and how far away these are.
class SeenPoints {
 public:
  SeenPoints(const MapMaterial& material, const std::vector<SegmentView>& views);

  /// Of each point with a known place, the views that see it.
  const std::vector<std::vector<std::size_t>>& viewsByPoint() const { return views_by_point_; }

  /// Of the points that a view sees, from its camera.
  const std::vector<double>& distances_m(std::size_t view) const { return by_view_[view].distances_m; }

  /// Whether a place is clearly farther away than all points that the view sees nearest to its direction: then the view
  /// sees something in front of it. Empty where too few points are around.
  std::optional<bool> isBehind(std::size_t view, const Eigen::Vector3d& p_w) const;

 private:
  struct Points {
    Eigen::Vector3d p_w_c;
    std::vector<Eigen::Vector3d> rays_w;  // unit
    std::vector<double> distances_m;
  };
  std::vector<Points> by_view_;
  std::vector<std::vector<std::size_t>> views_by_point_;
};

}  // namespace lintel
