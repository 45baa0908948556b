// SPDX-License-Identifier: BSD-3-Clause
#include "ImuValuesStream.h"

#include "TimeTicks.h"

namespace lintel {

/// From one to the next.
void ImuValuesStream::handOn(bool at_end, const WarningSink& warn) {
  while (const std::optional<ImuSample> sample = held_.pop(at_end)) spikes_.push(*sample);
  handOnMended(at_end, warn);
  if (said_ || !held_.hasLooked()) return;
  said_ = true;
  if (!held_.remark().empty()) warn(Fault::Other, path() + ": " + held_.remark() + ": interpolated");
}

/// Those whose spikes are replaced.
void ImuValuesStream::handOnMended(bool at_end, const WarningSink& warn) {
  std::string remark;
  while (const std::optional<ImuSample> sample = spikes_.pop(at_end, remark)) {
    if (!remark.empty())
      warn(Fault::ImuSpike, path() + ": IMU sample at " + secondsText(sample->t_ns) + ": " + remark + ": replaced");
    ends_.push(*sample);
  }
}

std::optional<ImuSample> ImuValuesStream::pop(bool at_end, const WarningSink& warn) {
  std::string remark;
  const std::optional<ImuSample> sample = ends_.pop(at_end, remark);
  if (!remark.empty())
    warn(Fault::ImuRange, path() + ": " + remark + " (estimated from " + secondsText(sample->t_ns) +
                              " on), the end of its range: set a larger range");
  return sample;
}

std::optional<ImuSample> ImuValuesStream::nextImu(std::int64_t needed_ns, const WarningSink& warn) {
  const auto read = [&](std::int64_t ahead_ns) { return source().nextImu(needed_ns + ahead_ns, warn); };
  while (true) {
    if (const std::optional<ImuSample> sample = pop(false, warn)) return sample;
    const std::optional<ImuSample> next = ahead_.next(read, held_.hasLooked() ? 0 : HeldValues::kLook_ns);
    if (next) held_.push(*next);
    handOn(!next, warn);
    if (next) continue;
    const std::optional<ImuSample> last = pop(true, warn);
    if (!last) ahead_.endOrFault();
    return last;
  }
}

}  // namespace lintel
