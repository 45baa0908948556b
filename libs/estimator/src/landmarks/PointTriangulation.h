// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Poses of the window's cameras as they are now, at the times of the stamps: worked out once for all points. A window
/// may be given in its place where a single point is looked at.
class CameraPoses {
 public:
  CameraPoses(const SlidingWindow& window);

  const SlidingWindow& window() const { return window_; }
  const Pose& T_w_c(FrameId id) const { return of(id).T_w_c; }  ///< of a frame of the window
  const Pose& T_c_w(FrameId id) const { return of(id).T_c_w; }

 private:
  struct FramePose {
    FrameId id;
    Pose T_w_c, T_c_w;
  };
  const FramePose& of(FrameId id) const;

  const SlidingWindow& window_;
  std::vector<FramePose> poses_;
};

/// Inverse depth of a point from all its sightings with the window's poses: linear start, Gauss-Newton on the
/// rays. Sets point, origin_w, sigma_inverse_depth and triangulated; a point whose depth is not yet
/// known to point_max_relative_sigma waits: linearised at a wrong depth it would add information about translations
/// that it does not have. Returns false when it waits, lies behind a camera or its error is too large.
bool triangulatePoint(const CameraPoses& poses, const LandmarkParams& params, double sigma_px, PointTrack& track);

/// Triangulates every track with enough sightings that is not yet.
void triangulatePoints(SlidingWindow& window, const LandmarkParams& params, double sigma_px);

/// Lowers sigma_inverse_depth to what the present sightings give.
void updatePointUncertainty(const CameraPoses& poses, double sigma_px, PointTrack& track);

/// Mean reprojection error over the sightings, in pixels; infinity when behind a camera.
double reprojectionError(const CameraPoses& poses, const PointTrack& track);

}  // namespace lintel
