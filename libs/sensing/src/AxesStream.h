// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "StreamFilter.h"

namespace lintel {

/// A stream whose IMU samples are corrected for what its axes are wrong by (Rig).
class AxesStream final : public StreamFilter {
 public:
  explicit AxesStream(std::unique_ptr<SensorStream> stream) : StreamFilter(std::move(stream)) {}

  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override {
    std::optional<ImuSample> sample = source().nextImu(needed_ns, warn);
    if (!sample) return sample;
    sample->accel += rig().axes.A * sample->accel;
    sample->gyro += rig().axes.G * sample->gyro;
    return sample;
  }
};

}  // namespace lintel
