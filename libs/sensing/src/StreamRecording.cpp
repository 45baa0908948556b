// SPDX-License-Identifier: BSD-3-Clause
#include "StreamRecording.h"

namespace lintel {

StreamRecording::StreamRecording(std::unique_ptr<SensorStream> stream, const RecordingParams& params)
    : rig_(stream->rig()),
      expected_frames_(stream->countFrames(params)),
      capacity_(params.frames_ahead),
      log_(stream->openingWarnings()),
      producer_(std::move(stream), params) {}

StreamRecording::~StreamRecording() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

StreamRecording::ItemPtr StreamRecording::produce() {
  auto item = std::make_unique<Item>();
  try {
    item->step = producer_.next();
  } catch (...) {
    item->error = std::current_exception();
  }
  return item;
}

void StreamRecording::runAhead() {
  for (bool last = false; !last;) {
    ItemPtr item = produce();
    last = item->last();
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return stop_ || queue_.size() < capacity_; });
    if (stop_) return;
    queue_.push_back(std::move(item));
    changed_.notify_all();
  }
}

StreamRecording::ItemPtr StreamRecording::take() {
  if (capacity_ == 0) return produce();
  if (!thread_.joinable()) thread_ = std::thread([this] { runAhead(); });
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !queue_.empty(); });
  ItemPtr item = std::move(queue_.front());
  queue_.pop_front();
  changed_.notify_all();
  return item;
}

std::optional<FrameWithImu> StreamRecording::next() {
  if (finished_) return std::nullopt;
  const ItemPtr item = take();
  finished_ = item->last();
  for (const Warning& warning : item->step.warnings) log_.add(warning);
  if (item->error) std::rethrow_exception(item->error);
  return std::move(item->step.frame);
}

}  // namespace lintel
