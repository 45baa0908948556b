// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// The offset between the clocks of images and IMU, as estimated from the camera's rotations.
struct ClockOffset {
  bool determined = false;     ///< the camera has turned enough, and one offset fits clearly better than others
  double offset_s = 0;         ///< an image with stamp t shows the world at t + offset of the IMU's clock
  double sigma_s = 0;          ///< its standard deviation
  double readout_s = 0;        ///< of a rolling shutter: the given one where that is likely to be right
  double readout_sigma_s = 0;  ///< its standard deviation; 0 where it is the given one
  Eigen::Vector3d bias_gyro = Eigen::Vector3d::Zero();  ///< of the whole span [rad/s]
  double rms_px = 0;                                    ///< what remains of the epipolar constraint at the offset
};

constexpr double kLargestClockOffset_s = 0.1;

/// Searches the offset at which the gyroscope's rotations fit the images' points best: for every offset on a grid
/// gyro bias and all directions of translation are estimated anew (EpipolarRotation), so that neither a bias nor
/// parallax is taken for an offset. Rays are turned to their frames' times by their rows; where the readout is not
/// clearly as given, it is estimated together with the offset. `frames` and `imu` ascend in time; pairs of frames whose
/// surroundings the IMU does not cover are left out.
ClockOffset findClockOffset(const std::vector<FrameTracks>& frames, const ImuBatch& imu, const Rig& rig);

}  // namespace lintel
