// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "StreamFilter.h"

namespace lintel {

/// A stream whose IMU's stamps are moved by a constant: to the images' clock.
class ShiftedStream final : public StreamFilter {
 public:
  ShiftedStream(std::unique_ptr<SensorStream> stream, std::int64_t shift_ns)
      : StreamFilter(std::move(stream)), shift_ns_(shift_ns) {}

  std::optional<ImuSample> nextImu(std::int64_t needed_ns, const WarningSink& warn) override {
    std::optional<ImuSample> sample = source().nextImu(needed_ns - shift_ns_, warn);
    if (sample) sample->t_ns += shift_ns_;
    return sample;
  }

 private:
  std::int64_t shift_ns_;
};

}  // namespace lintel
