// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

/// Finds points that lie on lines (doc/method/degeneracy.md: they determine the distance of degenerate lines).
class PointsOnLines {
 public:
  PointsOnLines(const KeyframeCameras& cameras, const std::vector<PointRecord>& points);

  /// Points that lie on a line of direction `direction_w`: on its views in nearly all keyframes that saw both, and,
  /// where they are several, most of them on one parallel of that direction. Whether they agree with the views is
  /// checked by the fit.
  std::vector<PointOnLine> on(const LineRecord& line, const Eigen::Vector3d& direction_w) const;

 private:
  struct Sighting {
    std::size_t point;
    Eigen::Vector2d px;
  };

  std::vector<PointOnLine> seenOn(const LineRecord& line, const Eigen::Vector3d& direction_w) const;

  const KeyframeCameras& cameras_;
  const std::vector<PointRecord>& points_;
  std::vector<std::vector<Sighting>> seen_;  // by keyframe id
};

}  // namespace lintel
