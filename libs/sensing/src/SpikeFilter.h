// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "lintel/core/Frame.h"

namespace lintel {

/// Single values of an IMU that stand out from the samples around them, as a disturbed bus makes them. What a body does
/// shows in more than one sample, as the sensor's low-pass filter spreads it. They are replaced by the mean of the
/// sample before and the sample after.
class SpikeFilter {
 public:
  /// Ascending in time.
  void push(const ImuSample& sample) { samples_.push_back(sample); }

  /// The next sample, once those around it are known or `at_end`; `remark` says why, if it was replaced.
  std::optional<ImuSample> pop(bool at_end, std::string& remark);

 private:
  static constexpr std::size_t kAround = 10;  // samples to both sides

  double difference(std::size_t i, int axis) const;
  bool isSpike(std::size_t i, int axis) const;
  std::string fault(std::size_t i) const;

  std::deque<ImuSample> samples_;  ///< as they came; the next one is at `next_`
  std::size_t next_ = 0;
};

}  // namespace lintel
