// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/ShiftedRecording.h"

#include <cmath>
#include <limits>
#include <utility>

#include "ImuBatcher.h"

namespace lintel {

ShiftedRecording::ShiftedRecording(Recording& source, std::deque<FrameWithImu> read, double offset_s,
                                   std::exception_ptr fault)
    : source_(source),
      shift_ns_(-std::llround(1e9 * offset_s)),
      fault_(std::move(fault)),  // NOLINT(bugprone-throw-keyword-missing): kept here, thrown by read()
      ahead_(std::move(read)),
      newest_ns_(std::numeric_limits<std::int64_t>::min()),
      batcher_(std::make_unique<ImuBatcher>([this](std::int64_t) { return nextSample(); })) {}

ShiftedRecording::~ShiftedRecording() = default;

std::optional<FrameWithImu> ShiftedRecording::read() {
  if (fault_) std::rethrow_exception(fault_);
  return source_.next();
}

/// Takes the IMU of one more frame. False at the end of the recording.
bool ShiftedRecording::readOn() {
  if (taken_ == ahead_.size()) {
    std::optional<FrameWithImu> step = read();
    if (!step) return false;
    ahead_.push_back(std::move(*step));
  }
  take(ahead_[taken_++].imu);
  return true;
}

/// The ends of a batch are interpolated; that they are samples now changes nothing, they lie on the same lines.
void ShiftedRecording::take(const ImuBatch& batch) {
  for (ImuSample sample : batch) {
    sample.t_ns += shift_ns_;
    if (sample.t_ns <= newest_ns_) continue;
    newest_ns_ = sample.t_ns;
    samples_.push_back(sample);
  }
}

std::optional<ImuSample> ShiftedRecording::nextSample() {
  while (samples_.empty())
    if (!readOn()) return std::nullopt;
  const ImuSample sample = samples_.front();
  samples_.pop_front();
  return sample;
}

std::optional<FrameWithImu> ShiftedRecording::next() {
  if (shift_ns_ == 0 && ahead_.empty()) return read();
  if (ahead_.empty() && !readOn()) return std::nullopt;
  if (shift_ns_ == 0) {
    FrameWithImu step = std::move(ahead_.front());
    ahead_.pop_front();
    return step;
  }
  const std::int64_t t_ns = ahead_.front().frame.t_ns;
  ImuBatch imu = first_ ? batcher_->before(t_ns) : batcher_->between(previous_ns_, t_ns);
  if (taken_ == 0) readOn();
  FrameWithImu step = std::move(ahead_.front());
  ahead_.pop_front();
  --taken_;
  step.imu = std::move(imu);
  previous_ns_ = t_ns;
  first_ = false;
  return step;
}

}  // namespace lintel
