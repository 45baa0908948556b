// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "Resection.h"
#include "lintel/geometry/Camera.h"
#include "lintel/places/PlaceSearch.h"

namespace lintel {

/// A point that was tracked around a keyframe, and what it looked like.
struct LocalPoint {
  TrackId track = 0;
  Eigen::Vector3d p_w;
  PlaceDescriptor look;
};

/// Points with a position that the keyframe or its neighbours in time (up to `reach` on each side) have tracked.
std::vector<LocalPoint> localPoints(const std::vector<PlaceKeyframe>& keyframes, std::size_t at, std::size_t reach,
                                    const std::unordered_map<TrackId, Eigen::Vector3d>& points_w);

/// A local point and the feature that looks like it.
struct LookAlike {
  std::size_t point = 0, feature = 0;
  int bits = 256;  ///< in which they differ
};

/// For each point the most similar feature of a view, if it differs in at most `max_bits` bits and clearly less than
/// any feature elsewhere in the image; each place in the image once.
std::vector<LookAlike> matchByLooks(const std::vector<LocalPoint>& points, const PlaceView& view, int max_bits);

/// Tracks of the view that lie where the pose sees a local point that looks like them.
std::vector<SamePoint> matchByPose(const Camera& camera, const std::vector<LocalPoint>& points, const PlaceView& view,
                                   const Pose& T_w_c, double max_error_px, int max_bits);

}  // namespace lintel
