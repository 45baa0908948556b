// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HeldValues.h"
#include "RangeEnds.h"
#include "ReadAhead.h"
#include "SpikeFilter.h"
#include "StreamFilter.h"

namespace lintel {

/// A stream whose IMU's values are mended where the recorder repeated or spoiled them, and where the sensor's range
/// ends (HeldValues, SpikeFilter, RangeEnds).
class ImuValuesStream final : public StreamFilter {
 public:
  using StreamFilter::StreamFilter;

  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override;

 private:
  void handOn(bool at_end, const WarningSink& warn);
  void handOnMended(bool at_end, const WarningSink& warn);
  std::optional<ImuSample> pop(bool at_end, const WarningSink& warn);

  ReadAhead<ImuSample> ahead_;
  HeldValues held_;
  SpikeFilter spikes_;
  RangeEnds ends_;
  bool said_ = false;
};

}  // namespace lintel
