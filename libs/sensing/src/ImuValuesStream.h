// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "HeldValues.h"
#include "ReadAhead.h"
#include "SensorStream.h"
#include "SpikeFilter.h"

namespace lintel {

/// A stream whose IMU's values are mended where the recorder repeated or spoiled them (HeldValues, SpikeFilter).
class ImuValuesStream final : public SensorStream {
 public:
  explicit ImuValuesStream(std::unique_ptr<SensorStream> stream) : stream_(std::move(stream)) {}

  const Rig& rig() const override { return stream_->rig(); }
  const std::string& path() const override { return stream_->path(); }
  std::vector<Warning> openingWarnings() const override { return stream_->openingWarnings(); }
  std::size_t countFrames(const RecordingParams& params) const override { return stream_->countFrames(params); }
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override { return stream_->nextFrame(warn); }
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  void handOn(bool at_end, const WarningSink& warn);
  std::optional<ImuSample> pop(bool at_end, const WarningSink& warn);

  std::unique_ptr<SensorStream> stream_;
  ReadAhead<ImuSample> ahead_;
  HeldValues held_;
  SpikeFilter spikes_;
  bool said_ = false;
};

}  // namespace lintel
