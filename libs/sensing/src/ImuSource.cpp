// SPDX-License-Identifier: BSD-3-Clause
#include "ImuSource.h"

#include "ImuBatcher.h"

namespace lintel {

/// Reads on until before_ <= t < after_ or at the end. False when no later time can be bracketed.
bool ImuJoiner::bracket(std::int64_t t_ns, const WarningSink& warn) {
  if (!after_) after_ = accel_(warn);
  while (after_ && after_->t_ns < t_ns) {
    before_ = after_;
    after_ = accel_(warn);
  }
  return after_.has_value();
}

std::optional<ImuSample> ImuJoiner::next(const WarningSink& warn) {
  while (std::optional<ImuSample> sample = gyro_(warn)) {
    if (!bracket(sample->t_ns, warn)) return std::nullopt;
    if (after_->t_ns == sample->t_ns) {
      sample->accel = after_->accel;
      return sample;
    }
    if (!before_ || after_->t_ns - before_->t_ns > ImuBatcher::kMaxGap_ns) continue;
    const double s =
        static_cast<double>(sample->t_ns - before_->t_ns) / static_cast<double>(after_->t_ns - before_->t_ns);
    sample->accel = before_->accel + s * (after_->accel - before_->accel);
    return sample;
  }
  return std::nullopt;
}

}  // namespace lintel
