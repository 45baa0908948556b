// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EurocFolder.h"
#include "GivenCalibration.h"
#include "SensorStream.h"

namespace lintel {

/// One camera and the IMU of an EuRoC folder.
class EurocStream final : public SensorStream {
 public:
  /// Throws RecordingError.
  EurocStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given);

  const Rig& rig() const override { return rig_; }
  const std::string& path() const override { return mav0_; }
  std::vector<Warning> openingWarnings() const override { return warnings_; }
  std::size_t countFrames(const RecordingParams& params) const override;
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override;
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  void checkOverlap() const;

  std::string mav0_, camera_folder_, imu_folder_;
  std::vector<Warning> warnings_;
  Rig rig_;
  EurocImageList images_;
  EurocImuList imu_;
};

}  // namespace lintel
