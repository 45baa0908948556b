// SPDX-License-Identifier: BSD-3-Clause
#include "StreamRecording.h"

namespace lintel {

StreamRecording::StreamRecording(std::unique_ptr<SensorStream> stream, const RecordingParams& params)
    : rig_(stream->rig()),
      expected_frames_(stream->countFrames(params)),
      runs_ahead_(params.frames_ahead > 0),
      log_(stream->openingWarnings()),
      producer_(std::move(stream), params),
      queue_(params.frames_ahead) {}

StreamRecording::~StreamRecording() {
  queue_.close();
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
    if (!queue_.push(std::move(item))) return;
  }
}

StreamRecording::ItemPtr StreamRecording::take() {
  if (!runs_ahead_) return produce();
  if (!thread_.joinable()) thread_ = std::thread([this] { runAhead(); });
  return std::move(*queue_.pop());  // never closed while values are taken
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
