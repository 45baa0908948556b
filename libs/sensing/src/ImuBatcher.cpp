// SPDX-License-Identifier: BSD-3-Clause
#include "ImuBatcher.h"

#include <algorithm>

namespace lintel {
namespace {

ImuSample interpolate(const ImuSample& a, const ImuSample& b, std::int64_t t_ns) {
  const double s = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
  return {t_ns,      a.gyro + s * (b.gyro - a.gyro),     a.accel + s * (b.accel - a.accel),
          b.bridged, std::max(a.gyro_open, b.gyro_open), std::max(a.accel_open, b.accel_open)};
}

bool earlier(const ImuSample& sample, std::int64_t t_ns) { return sample.t_ns < t_ns; }

}  // namespace

void ImuBatcher::readTo(std::int64_t t_ns, std::int64_t keep_from_ns) {
  const auto forget = [&] {
    while (samples_.size() > 1 && samples_[1].t_ns <= keep_from_ns) samples_.pop_front();
  };
  forget();
  while (samples_.empty() || samples_.back().t_ns < t_ns) {
    const std::optional<ImuSample> sample = next_(t_ns);
    if (!sample) return;
    append(*sample);
    forget();
  }
}

void ImuBatcher::append(ImuSample sample) {
  if (!samples_.empty()) {
    const ImuSample before = samples_.back();
    const std::int64_t gap_ns = sample.t_ns - before.t_ns;
    sample.bridged = gap_ns > kMaxGap_ns && gap_ns <= kMaxBridge_ns;
    for (std::int64_t t_ns = before.t_ns + kBridgeStep_ns; sample.bridged && t_ns < sample.t_ns; t_ns += kBridgeStep_ns)
      samples_.push_back(interpolate(before, sample, t_ns));
  }
  samples_.push_back(sample);
}

std::optional<ImuSample> ImuBatcher::at(std::int64_t t_ns) const {
  const auto right = std::lower_bound(samples_.begin(), samples_.end(), t_ns, earlier);
  if (right == samples_.end()) return std::nullopt;
  if (right->t_ns == t_ns) return *right;
  if (right == samples_.begin() || right->t_ns - (right - 1)->t_ns > kMaxGap_ns) return std::nullopt;
  return interpolate(*(right - 1), *right, t_ns);
}

ImuBatch ImuBatcher::before(std::int64_t t_ns) {
  readTo(t_ns, t_ns - kLeadIn_ns);
  const std::optional<ImuSample> last = at(t_ns);
  if (!last) return {};
  const auto end = std::lower_bound(samples_.begin(), samples_.end(), t_ns, earlier);
  auto begin = end;
  std::int64_t after_ns = t_ns;
  while (begin != samples_.begin() && (begin - 1)->t_ns >= t_ns - kLeadIn_ns &&
         after_ns - (begin - 1)->t_ns <= kMaxGap_ns && !(begin != samples_.end() && begin->bridged))
    after_ns = (--begin)->t_ns;
  ImuBatch batch(begin, end);
  batch.push_back(*last);
  return batch;
}

ImuBatch ImuBatcher::between(std::int64_t t0_ns, std::int64_t t1_ns) {
  readTo(t1_ns, t0_ns);
  const std::optional<ImuSample> first = at(t0_ns), last = at(t1_ns);
  if (!first || !last) return {};
  ImuBatch batch{*first};
  auto it = std::upper_bound(samples_.begin(), samples_.end(), t0_ns,
                             [](std::int64_t t, const ImuSample& sample) { return t < sample.t_ns; });
  for (; it != samples_.end() && it->t_ns < t1_ns; ++it) batch.push_back(*it);
  batch.push_back(*last);
  const auto gap = [](const ImuSample& a, const ImuSample& b) { return b.t_ns - a.t_ns > kMaxGap_ns; };
  if (std::adjacent_find(batch.begin(), batch.end(), gap) != batch.end()) return {};
  return batch;
}

}  // namespace lintel
