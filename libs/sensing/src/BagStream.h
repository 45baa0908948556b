// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "Bag.h"
#include "GivenCalibration.h"
#include "ImuSource.h"
#include "SampleGate.h"
#include "SensorStream.h"

namespace lintel {

/// One topic of images and one of the IMU, or one each of its gyroscope and its accelerometer, of a ROS bag. Images and
/// samples are read by readers of their own, so that neither waits for the other.
class BagStream final : public SensorStream {
 public:
  /// Throws RecordingError.
  BagStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given);

  const Rig& rig() const override { return rig_; }
  const std::string& path() const override { return path_; }
  std::vector<Warning> openingWarnings() const override { return warnings_; }
  /// Known when all are wanted only.
  std::size_t countFrames(const RecordingParams& params) const override;
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override;
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  ImuSource openImu(const BagTopic& topic) const;
  Rig uncalibrated() const;
  void checkOverlap() const;

  std::string path_;
  std::vector<Warning> warnings_;
  std::unique_ptr<Bag> bag_;
  BagTopic images_;
  std::vector<BagTopic> imus_;  ///< one, or gyroscope and accelerometer
  Rig rig_;
  std::unique_ptr<BagReader> image_reader_;
  StampGate image_gate_{"image", Fault::ImageStamp};
  ImuSource imu_;
};

}  // namespace lintel
