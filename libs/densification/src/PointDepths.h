// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "SegmentView.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// How far away the points are that each view sees.
class PointDepths {
 public:
  PointDepths(const MapMaterial& material, const std::vector<SegmentView>& views);

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
};

}  // namespace lintel
