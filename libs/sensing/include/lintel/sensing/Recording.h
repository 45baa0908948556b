// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// What is wrong with a recording: one line naming the file, the line or time, and the remedy.
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What to read of a recording.
struct RecordingParams {
  double from_s = 0;                     ///< skip frames before this time after the first frame [s]
  double to_s = 0;                       ///< stop after this time after the first frame [s]; 0 = to the end
  std::string camera;                    ///< folder or sensor label; empty = cam0, in a rawlog the alphabetically first
  std::string imu;                       ///< folder or sensor label; empty = imu0, in a rawlog the alphabetically first
  std::vector<std::string> calibration;  ///< files that replace the recording's own calibration (Calibration.h)
  std::string times_file;                ///< of a film or a folder of images; empty = the one beside it (PlainStream.h)
  std::string imu_file;                  ///< the same of the IMU's samples; GYRO,ACCEL where they are two
  std::string mask;                      ///< image of the camera's size, black where images are not used; empty = none
  double gravity_m_s2 = kGravity;        ///< where the recording was made; 1 to 30
  std::size_t frames_ahead = 8;          ///< frames decoded ahead on another thread; 0 = decode when asked
};

/// A recording as a time-ordered stream. Memory does not grow with its length (images are decoded as they are needed).
class Recording {
 public:
  virtual ~Recording() = default;

  virtual const Rig& rig() const = 0;

  /// The next frame with the IMU before it; empty at the end. Throws RecordingError on what cannot be read further
  /// (what was delivered before stays valid). Small faults (a missing image, a duplicated or reordered sample, a
  /// non-finite value) are skipped and noted in `warnings()`.
  virtual std::optional<FrameWithImu> next() = 0;

  /// Number of frames that the stream will deliver, if it is known beforehand (progress bars); else 0.
  virtual std::size_t expectedFrames() const = 0;

  /// Faults met so far, one line each, at most a few of a kind and then their count.
  virtual std::vector<std::string> warnings() const = 0;
};

/// Opens an EuRoC folder (`…/mav0` or its parent), a `.rawlog`, a ROS bag, a film, or a folder of images. Throws
/// RecordingError.
std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingParams& params = {});

}  // namespace lintel
