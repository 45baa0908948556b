// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "lintel/pipeline/Odometry.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel {

/// What tracking hands to estimation.
struct TrackedFrame {
  FrameWithImu step;
  FrameTracks tracks;
  CameraTurn turn;  ///< since the frame before
};

/// Reads the recording and tracks points and lines. Of the result it writes only what the other stage does not touch
/// (`error`, the times of decoding and tracking), so that both may run at the same time.
class TrackingStage {
 public:
  TrackingStage(Recording& recording, const FrontEndParams& params, OdometryResult& result)
      : recording_(recording), front_end_(recording.rig(), params), result_(result) {}

  /// Empty at the end of the recording; a fault ends it with `error` set.
  std::optional<TrackedFrame> next() {
    TrackedFrame frame;
    if (!again_.empty()) {
      frame = std::move(again_.front());
      again_.pop_front();
      leaveOutVehicle(frame.tracks);
      return frame;
    }
    if (ended_) return std::nullopt;
    ended_ = true;  // unless there is a frame
    try {
      auto step = recording_.next();
      if (!step) return std::nullopt;
      frame.step = std::move(*step);
      result_.statistics.decoding.add(frame.step.reading_ms);
    } catch (const RecordingError& e) {
      result_.error = e.what();
      return std::nullopt;
    }
    const StageClock::Scope scope(result_.statistics.tracking);
    frame.tracks = front_end_.process(frame.step.frame, frame.step.imu);
    frame.turn = front_end_.turn();
    ended_ = false;
    return frame;
  }

  /// Frames that next() has given: it gives them once more, before those that follow.
  void giveAgain(std::deque<TrackedFrame> frames) { again_ = std::move(frames); }

  /// Leaves out what is now known to move with the camera.
  void leaveOutVehicle(FrameTracks& tracks) const { front_end_.leaveOutVehicle(tracks); }

  std::shared_ptr<const GrayImage> foundMask() const { return front_end_.foundMask(); }
  const FrontEndStatistics& statistics() const { return front_end_.statistics(); }

 private:
  Recording& recording_;
  FrontEnd front_end_;
  OdometryResult& result_;
  std::deque<TrackedFrame> again_;
  bool ended_ = false;
};

}  // namespace lintel
