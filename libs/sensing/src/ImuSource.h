// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "Warnings.h"
#include "lintel/core/Frame.h"

namespace lintel {

/// Gives the next sample, times strictly increasing; empty at the end.
using ImuSource = std::function<std::optional<ImuSample>(const WarningSink& warn)>;

/// Joins a stream of angular rates and one of accelerations, as some cameras give them: samples at the times of the
/// gyroscope, accelerations interpolated linearly. Where the accelerometer has a drop-out or nothing at all, there is
/// no sample.
class ImuJoiner {
 public:
  ImuJoiner(ImuSource gyro, ImuSource accel) : gyro_(std::move(gyro)), accel_(std::move(accel)) {}

  std::optional<ImuSample> next(const WarningSink& warn);

 private:
  bool bracket(std::int64_t t_ns, const WarningSink& warn);

  ImuSource gyro_, accel_;
  std::optional<ImuSample> before_, after_;
};

}  // namespace lintel
