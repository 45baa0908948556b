// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EvenTimes.h"
#include "FrameTimes.h"
#include "SampleGate.h"
#include "SampleTimes.h"
#include "StreamFilter.h"

namespace lintel {

/// A stream whose images and IMU samples have even times where they were stamped on arrival; else as it is, but for
/// samples with the time of the one before.
class ArrivalStream final : public StreamFilter {
 public:
  using StreamFilter::StreamFilter;

  std::optional<FrameRef> nextFrame(const WarningSink& warn) override;
  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  EvenTimes<FrameRef, FrameTimes> frames_;
  EvenTimes<ImuSample, SampleTimes> samples_;
  StampGate gate_{"IMU sample", Fault::ImuStamp};
};

}  // namespace lintel
