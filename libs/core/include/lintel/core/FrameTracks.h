// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lintel {

using TrackId = std::uint64_t;  ///< unique over a run, never reused; points and lines count separately

/// A tracked point in one frame.
struct PointObservation {
  TrackId id = 0;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();    ///< raw (distorted) pixels
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  ///< of the calibrated camera (Camera.h)
  int track_length = 1;                            ///< frames in which it has been seen, this one included
};

/// A tracked line segment in one frame. Start and end keep their order over the life of a track.
struct LineObservation {
  TrackId id = 0;
  Eigen::Vector2d start_px = Eigen::Vector2d::Zero(), end_px = Eigen::Vector2d::Zero();  ///< raw (distorted) pixels
  Eigen::Vector3d start = Eigen::Vector3d::UnitZ(), end = Eigen::Vector3d::UnitZ();      ///< their rays (Camera.h)
  double sigma_px = 1.0;  ///< standard deviation of an end's distance from the true line [px]
  int track_length = 1;   ///< frames in which it has been seen, this one included
  bool detected = true;   ///< seen by the detector in this frame; false: position predicted by optical flow alone
};

/// All features of one frame with their identity over time.
struct FrameTracks {
  std::int64_t t_ns = 0;
  std::vector<PointObservation> points;  ///< ascending id
  std::vector<LineObservation> lines;    ///< ascending id
};

}  // namespace lintel
