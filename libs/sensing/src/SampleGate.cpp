// SPDX-License-Identifier: BSD-3-Clause
#include "SampleGate.h"

#include <algorithm>

#include "TimeTicks.h"

namespace lintel {

namespace {

constexpr double kBeyondAnySensor = 1e6;  // rad/s, m/s^2: raw counts are less and have a check of their own

}  // namespace

bool StampGate::admit(std::int64_t t_ns, const std::function<std::string()>& where, const WarningSink& warn) {
  if (t_ns > last_ns_) {
    last_ns_ = t_ns;
    return true;
  }
  const char* fault = t_ns == last_ns_ ? "has the same time as the one before" : "is older than the one before";
  warn(fault_, where() + ": " + what_ + " at " + secondsText(t_ns) + " " + fault + ": skipped");
  return false;
}

bool ImuGate::admit(const ImuSample& sample, const std::function<std::string()>& where, const WarningSink& warn) {
  const bool finite = sample.gyro.allFinite() && sample.accel.allFinite();
  if (finite && std::max(sample.gyro.cwiseAbs().maxCoeff(), sample.accel.cwiseAbs().maxCoeff()) < kBeyondAnySensor) {
    const bool another =
        last_ && sample.t_ns == last_->t_ns && (sample.gyro != last_->gyro || sample.accel != last_->accel);
    const bool pass = another || stamps_.admit(sample.t_ns, where, warn);
    if (pass) last_ = sample;
    return pass;
  }
  warn(Fault::ImuValue, where() + ": IMU sample at " + secondsText(sample.t_ns) +
                            (finite ? " is beyond what any sensor measures: skipped" : " is not finite: skipped"));
  return false;
}

}  // namespace lintel
