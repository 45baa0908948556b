// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "StepProducer.h"

namespace lintel {

/// The Recording of both routes: a StepProducer, run ahead on a thread of its own when asked to. What the caller sees
/// (frames, warnings, errors and their order) does not depend on how far the thread has come.
class StreamRecording final : public Recording {
 public:
  StreamRecording(std::unique_ptr<SensorStream> stream, const RecordingParams& params);
  ~StreamRecording() override;

  const Rig& rig() const override { return rig_; }
  std::optional<FrameWithImu> next() override;
  std::size_t expectedFrames() const override { return expected_frames_; }
  std::vector<std::string> warnings() const override { return log_.lines(); }

 private:
  struct Item {
    Step step;
    std::exception_ptr error;
    bool last() const { return error || !step.frame; }
  };
  using ItemPtr = std::unique_ptr<Item>;
  ItemPtr produce();
  ItemPtr take();
  void runAhead();

  Rig rig_;
  std::size_t expected_frames_, capacity_;
  WarningLog log_;
  StepProducer producer_;
  bool finished_ = false;

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ItemPtr> queue_;
  bool stop_ = false;
};

}  // namespace lintel
