// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <vector>

#include "TwoViewMotion.h"
#include "lintel/core/FrameTracks.h"

namespace lintel {

/// Finds tracks that drift slowly: patches on the outline of something near, or slipping along an edge, pass every
/// check between consecutive frames, but leave their epipolar line over a longer baseline.
class DriftCheck {
 public:
  DriftCheck(int gap_frames, const TwoViewParams& params) : gap_frames_(gap_frames), params_(params) {}

  /// The tracks of the next frame, ascending id, and the rotation since the one before.
  void push(const std::vector<PointObservation>& points, const Eigen::Quaterniond& R_c1_c0);

  /// Ids, ascending, of tracks that contradict the motion over the last `gap_frames`; empty while there are fewer
  /// frames.
  std::vector<TrackId> drifting() const;

 private:
  struct Entry {
    std::vector<PointObservation> points;
    Eigen::Quaterniond R_c_ct;  // ct: the camera at the time of the entry
  };

  int gap_frames_;
  TwoViewParams params_;
  std::deque<Entry> entries_;  ///< oldest first
};

}  // namespace lintel
