// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/factors/CameraView.h"

namespace lintel {

/// Poses of the window's cameras as they are now: worked out once for all landmarks. A window may be given in its place
/// where a single landmark is looked at.
class CameraPoses {
 public:
  CameraPoses(const SlidingWindow& window);

  const SlidingWindow& window() const { return window_; }
  const Camera& camera() const { return window_.camera(); }
  const double* correction() const { return window_.correction.data(); }

  // Of a frame of the window.
  const Pose& T_w_c(FrameId id) const { return of(id).T_w_c; }  ///< at the time of the stamp
  const Pose& T_c_w(FrameId id) const { return of(id).T_c_w; }
  const CameraView& view(FrameId id) const { return of(id).view; }  ///< at that of the image; without derivatives

 private:
  struct FramePose {
    FrameId id;
    Pose T_w_c, T_c_w;
    CameraView view;
  };
  const FramePose& of(FrameId id) const;

  const SlidingWindow& window_;
  std::vector<FramePose> poses_;
};

}  // namespace lintel
