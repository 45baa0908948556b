// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "SensorStream.h"

namespace lintel {

/// A stream whose IMU's stamps are moved by a constant: to the images' clock.
class ShiftedStream final : public SensorStream {
 public:
  ShiftedStream(std::unique_ptr<SensorStream> stream, std::int64_t shift_ns)
      : stream_(std::move(stream)), shift_ns_(shift_ns) {}

  const Rig& rig() const override { return stream_->rig(); }
  const std::string& path() const override { return stream_->path(); }
  std::vector<Warning> openingWarnings() const override { return stream_->openingWarnings(); }
  std::size_t countFrames(const RecordingParams& params) const override { return stream_->countFrames(params); }
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override { return stream_->nextFrame(warn); }
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override {
    std::optional<ImuSample> sample = stream_->nextImu(needed_ns - shift_ns_, warn);
    if (sample) sample->t_ns += shift_ns_;
    return sample;
  }

 private:
  std::unique_ptr<SensorStream> stream_;
  std::int64_t shift_ns_;
};

}  // namespace lintel
