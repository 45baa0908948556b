// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "GyroPrediction.h"
#include "ImageLine.h"
#include "ImagePyramid.h"
#include "PointTracker.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/tracking/FrontEndParams.h"
#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// Lines with identity over time.
class LineTracker {
 public:
  virtual ~LineTracker() = default;

  /// Takes the pyramid's current frame; `points` is what tracked points did on the way to it.
  virtual void process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
                       FrontEndStatistics& statistics) = 0;

  /// What places along detected lines did since the detection before, across the lines; empty without a detection.
  virtual std::vector<FollowedPoint> followed() const { return {}; }

  /// Lines of the current frame, ascending id.
  virtual const std::vector<LineObservation>& lines() const = 0;
};

/// What the estimator gets of a line. `sigma_px`: standard deviation of an end across the line; `track_length`: frames
/// that have seen it, this one included; `detected`: by the detector in this frame.
LineObservation lineObservation(const LineCamera& camera, TrackId id, const ImageLine& line, double sigma_px,
                                int track_length, bool detected);

/// The tracker of params.mode.
std::unique_ptr<LineTracker> makeLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params);

}  // namespace lintel
