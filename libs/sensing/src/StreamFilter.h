// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "SensorStream.h"

namespace lintel {

/// A stream that hands on another one; what derives from it changes one thing.
class StreamFilter : public SensorStream {
 public:
  explicit StreamFilter(std::unique_ptr<SensorStream> stream) : stream_(std::move(stream)) {}

  const Rig& rig() const override { return stream_->rig(); }
  const std::string& path() const override { return stream_->path(); }
  std::vector<Warning> openingWarnings() const override { return stream_->openingWarnings(); }
  std::size_t countFrames(const RecordingParams& params) const override { return stream_->countFrames(params); }
  std::optional<FrameRef> nextFrame(const WarningSink& warn) override { return stream_->nextFrame(warn); }

 protected:
  SensorStream& source() { return *stream_; }

 private:
  std::unique_ptr<SensorStream> stream_;
};

}  // namespace lintel
