// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "GivenCalibration.h"
#include "RawlogFile.h"
#include "RawlogProbe.h"
#include "SampleGate.h"
#include "SensorStream.h"

namespace lintel {

/// One camera and one IMU of a rawlog. The file mixes both: what is read on the way to the one that is asked for waits.
class RawlogStream final : public SensorStream {
 public:
  /// Throws RecordingError.
  RawlogStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given);

  const Rig& rig() const override { return probe_.rig; }
  const std::string& path() const override { return path_; }
  std::vector<Warning> openingWarnings() const override { return probe_.warnings; }
  /// 0: the only way to know would be to read the whole file.
  std::size_t countFrames(const RecordingParams&) const override { return 0; }
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override;
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  /// Reads one observation; false at the end.
  bool pull(const WarningSink& warn);
  void takeImage(const std::shared_ptr<mrpt::obs::CObservation>& observation, const WarningSink& warn);
  void takeImu(const std::shared_ptr<mrpt::obs::CObservation>& observation, const WarningSink& warn);

  std::string path_;
  RawlogProbe probe_;
  std::string images_folder_;
  RawlogFile file_;
  StampGate image_gate_{"image", Fault::ImageStamp};
  ImuGate imu_gate_;
  std::deque<FrameRef> frames_;
  std::deque<ImuSample> samples_;
};

}  // namespace lintel
