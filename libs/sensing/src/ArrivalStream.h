// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ArrivalTimes.h"
#include "EvenTimes.h"
#include "FrameTimes.h"
#include "SampleGate.h"
#include "SensorStream.h"

namespace lintel {

/// A stream whose images and IMU samples have even times where they were stamped on arrival; else as it is, but for
/// samples with the time of the one before.
class ArrivalStream final : public SensorStream {
 public:
  explicit ArrivalStream(std::unique_ptr<SensorStream> stream) : stream_(std::move(stream)) {}

  const Rig& rig() const override { return stream_->rig(); }
  const std::string& path() const override { return stream_->path(); }
  std::vector<Warning> openingWarnings() const override { return stream_->openingWarnings(); }
  std::size_t countFrames(const RecordingParams& params) const override { return stream_->countFrames(params); }
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override;
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  std::unique_ptr<SensorStream> stream_;
  EvenTimes<FrameRef, FrameTimes> frames_;
  EvenTimes<ImuSample, ArrivalTimes> samples_;
  StampGate gate_{"IMU sample", Fault::ImuStamp};
};

}  // namespace lintel
