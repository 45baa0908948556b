// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <exception>
#include <memory>
#include <optional>

#include "ArrivalTimes.h"
#include "SensorStream.h"

namespace lintel {

/// A stream whose IMU's samples have even times where they were stamped on arrival (ArrivalTimes); else as it is.
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
  std::optional<ImuSample> read(std::int64_t needed_ns, const WarningSink& warn);
  void endOrFault() const;
  void look(std::int64_t needed_ns, const WarningSink& warn);

  std::unique_ptr<SensorStream> stream_;
  std::deque<ImuSample> first_;  ///< that were looked at and not handed on
  std::optional<ArrivalTimes> times_;
  std::exception_ptr fault_;  ///< met ahead of what was asked for
};

}  // namespace lintel
