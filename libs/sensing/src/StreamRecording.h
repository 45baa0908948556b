// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <memory>
#include <thread>

#include "StepProducer.h"
#include "lintel/core/BoundedQueue.h"

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

  Rig rig_;  ///< the stream's, with mask and gravity of the parameters
  std::size_t expected_frames_;
  bool runs_ahead_;
  WarningLog log_;
  StepProducer producer_;
  bool finished_ = false;

  BoundedQueue<ItemPtr> queue_;
  std::exception_ptr failure_;  ///< why the thread closed the queue
  std::thread thread_;
};

}  // namespace lintel
