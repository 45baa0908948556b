// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "lintel/core/Frame.h"

namespace lintel {

/// Values that a program which joins a slow sensor to a fast one has repeated until there was a new one, as drivers do
/// with an accelerometer of 63 Hz beside a gyroscope of 200 Hz: steps, late by half of the slow sensor's interval. Each
/// sample gets the value between the one that it repeats and the next.
class HeldValues {
 public:
  static constexpr std::int64_t kLook_ns = 2'000'000'000;

  /// Ascending in time. The first kLook_ns are looked at to see whether values are held.
  void push(const ImuSample& sample);

  /// The next sample, once the next value is known or `at_end`.
  std::optional<ImuSample> pop(bool at_end);

  bool hasLooked() const { return looked_; }
  const std::string& remark() const { return remark_; }  ///< which are held, in words; empty: none

 private:
  using Values = Eigen::Vector3d ImuSample::*;
  struct Sensor {
    Values values;
    const char* name;
    std::size_t reach = 0;  ///< samples in which a new value comes; 0: not held
  };
  void look();
  bool isKnown(const Sensor& sensor) const;
  Eigen::Vector3d between(const Sensor& sensor) const;

  Sensor sensors_[2] = {{&ImuSample::gyro, "angular rates"}, {&ImuSample::accel, "accelerations"}};
  std::deque<ImuSample> samples_;  ///< as they came; the next one is at `next_`, before it those of its run
  std::size_t next_ = 0;
  bool looked_ = false;
  std::string remark_;
};

}  // namespace lintel
