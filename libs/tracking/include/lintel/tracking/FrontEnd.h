// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "lintel/core/CameraTurn.h"
#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/tracking/FrontEndParams.h"
#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// Images and gyroscope in, features with identity out. Deterministic, whatever the number of OpenCV's threads, and
/// independent of the estimator, so that it may run on a thread of its own.
///
/// Every frame is tracked (small motion between images keeps tracks alive); the estimator may use every n-th result.
class FrontEnd {
 public:
  /// Throws std::invalid_argument, naming the parameter, when one is out of range or the rig has no image size.
  FrontEnd(const Rig& rig, const FrontEndParams& params);
  ~FrontEnd();
  FrontEnd(FrontEnd&&) noexcept;
  FrontEnd& operator=(FrontEnd&&) noexcept;

  /// Features of `frame`; none where the image shows nothing or repeats the one before while the camera turns: the
  /// next image continues the tracks. `imu_since_last` covers the time from the previous frame to this one
  /// (core/Frame.h); when it is empty the last rotation rate is assumed to go on. Throws std::invalid_argument when the
  /// image does not have the rig's size, or the frame is not later than the one before.
  FrameTracks process(const Frame& frame, const ImuBatch& imu_since_last);

  /// A mask (Rig.h) that leaves out what was found to move with the camera, as well as what the rig's leaves out; null
  /// as long as nothing was found.
  std::shared_ptr<const GrayImage> foundMask() const;

  /// Takes out of an earlier frame's features those where something has been found since that moves with the camera.
  void leaveOutVehicle(FrameTracks& tracks) const;

  /// How the camera turned from the frame before the last one to the last one, by its points alone; unknown where too
  /// few say the same.
  CameraTurn turn() const;

  const FrontEndStatistics& statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
