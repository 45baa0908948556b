// SPDX-License-Identifier: BSD-3-Clause
#include "ArrivalStream.h"

#include <cstdio>

namespace lintel {

namespace {

constexpr std::int64_t kLook_ns = 2'000'000'000;   // of samples, to see how they come
constexpr std::int64_t kAhead_ns = 1'500'000'000;  // what ArrivalTimes needs, and a packet

}  // namespace

/// Samples are read ahead of the frames that need them: a fault there must not take these.
std::optional<ImuSample> ArrivalStream::read(std::int64_t needed_ns, const WarningSink& warn) {
  if (fault_) return std::nullopt;
  try {
    return stream_->nextImu(needed_ns, warn);
  } catch (const RecordingError&) {
    fault_ = std::current_exception();
    return std::nullopt;
  }
}

/// Where the stream has no more.
void ArrivalStream::endOrFault() const {
  if (fault_) std::rethrow_exception(fault_);
}

void ArrivalStream::look(std::int64_t needed_ns, const WarningSink& warn) {
  while (first_.empty() || first_.back().t_ns - first_.front().t_ns < kLook_ns) {
    const std::optional<ImuSample> sample = read(needed_ns + kLook_ns, warn);
    if (!sample) break;
    first_.push_back(*sample);
  }
  times_.emplace(first_);
  if (!times_->found()) return;
  char text[80];
  std::snprintf(text, sizeof text, ": their times are taken as even, %.0f a second", times_->rate_hz());
  warn(Fault::Other, path() + ": " + times_->remark() + text);
  for (const ImuSample& sample : first_) times_->push(sample);
  first_.clear();
}

std::optional<FrameRef> ArrivalStream::nextFrame(const WarningSink& warn) {
  std::optional<FrameRef> frame = stream_->nextFrame(warn);
  if (!frame) endOrFault();
  return frame;
}

std::optional<ImuSample> ArrivalStream::nextImu(std::int64_t needed_ns, const WarningSink& warn) {
  if (!times_) look(needed_ns, warn);
  std::optional<ImuSample> sample;
  if (!times_->found()) {
    if (first_.empty()) {
      endOrFault();
      return stream_->nextImu(needed_ns, warn);
    }
    sample = first_.front();
    first_.pop_front();
    return sample;
  }
  while (!(sample = times_->pop(false))) {
    if (const std::optional<ImuSample> next = read(needed_ns + kAhead_ns, warn)) {
      times_->push(*next);
      continue;
    }
    sample = times_->pop(true);
    if (!sample) endOrFault();
    break;
  }
  return sample;
}

}  // namespace lintel
