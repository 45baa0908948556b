// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// Whether an image is to be tracked.
enum class ImageWorth {
  kGood,
  kShowsNothing,  ///< black, white or covered, where images of the last half second were not: the next may go on
  kStaysDark,     ///< shows nothing, as those before: tracked, so that tracks end
  kRepeats        ///< the pixels of the image before, though the camera has turned: one that hangs or is sent twice
};

/// Finds images that show nothing of the scene, or nothing new, by themselves and the gyroscope. Tracks that are
/// carried over them need not begin anew.
class ImageCheck {
 public:
  explicit ImageCheck(const Camera& camera) : focal_px_(camera.meanFocal()) {}

  /// `imu_since_last` covers the time since the last image; `gyro_bias` [rad/s] is what is known of it.
  ImageWorth check(const Frame& frame, const ImuBatch& imu_since_last, const Eigen::Vector3d& gyro_bias);

 private:
  ImageWorth contrastWorth(const Frame& frame);
  bool repeats(const Frame& frame, const ImuBatch& imu, const Eigen::Vector3d& gyro_bias);

  double focal_px_;
  std::shared_ptr<const GrayImage> last_;
  Eigen::Vector3d turned_rad_ = Eigen::Vector3d::Zero();  ///< while images have been the same
  double same_s_ = 0;
  double contrast_ = 0;        ///< of the last image that showed something [grey levels]
  std::int64_t shown_ns_ = 0;  ///< when that was
};

}  // namespace lintel
