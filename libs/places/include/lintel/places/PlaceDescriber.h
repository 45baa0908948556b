// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/geometry/Camera.h"
#include "lintel/places/PlaceView.h"

namespace lintel {

/// Describes images so that a place can be found again: binary descriptors (ORB, [Rublee2011]) of the tracked points
/// and of corners spread over the image. Patches are turned so that gravity points the same way in all of them.
class PlaceDescriber {
 public:
  explicit PlaceDescriber(const Camera& camera);
  ~PlaceDescriber();
  PlaceDescriber(PlaceDescriber&&) noexcept;

  /// `down_c`: direction of gravity in the camera frame.
  PlaceView describe(const Frame& frame, const std::vector<PointObservation>& tracked,
                     const Eigen::Vector3d& down_c) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
