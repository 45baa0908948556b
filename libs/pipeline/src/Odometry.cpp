// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Odometry.h"

#include <exception>
#include <stdexcept>
#include <thread>

#include "EstimationStage.h"
#include "TrackingStage.h"
#include "lintel/core/BoundedQueue.h"

namespace lintel {

namespace {

/// Takes a tracked frame; false when no more are wanted.
using FrameTaker = std::function<bool(const TrackedFrame&)>;

void trackOnThisThread(TrackingStage& tracking, const FrameTaker& take) {
  while (auto frame = tracking.next())
    if (!take(*frame)) return;
}

void trackOnItsOwnThread(TrackingStage& tracking, const FrameTaker& take) {
  BoundedQueue<TrackedFrame> queue(4);
  std::exception_ptr failure;
  std::thread thread([&] {
    try {
      while (auto frame = tracking.next())
        if (!queue.push(std::move(*frame))) break;
    } catch (...) {
      failure = std::current_exception();
    }
    queue.close();
  });
  try {
    while (auto frame = queue.pop())
      if (!take(*frame)) break;
  } catch (...) {
    queue.close();
    thread.join();
    throw;
  }
  queue.close();
  thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

OdometryResult runOdometry(Recording& recording, const Configuration& configuration, const RunOptions& options) {
  if (options.threads != 1 && options.threads != 2)
    throw std::invalid_argument("threads is " + std::to_string(options.threads) + ", must be 1 or 2");
  OdometryResult result;
  const auto cancelled = [&] {
    return result.cancelled = result.cancelled || (options.cancelled && options.cancelled());
  };
  TrackingStage tracking(recording, configuration.tracking, result);
  EstimationStage estimation(recording.rig(), configuration, result);
  const std::size_t expected_frames = recording.expectedFrames();
  const FrameTaker take = [&](const TrackedFrame& frame) {
    if (cancelled()) return false;
    const WindowUpdate update = estimation.process(frame);
    const std::size_t done = result.statistics.frames;
    if (options.progress) options.progress({RunStage::kFrames, done, expected_frames});
    if (options.observer) options.observer(frame.step.frame, frame.tracks, update, done);
    return true;
  };
  options.threads == 1 ? trackOnThisThread(tracking, take) : trackOnItsOwnThread(tracking, take);
  if (result.cancelled) result.error.clear();  // of frames ahead of the last one processed
  estimation.finish([&](double share) {
    if (options.progress) options.progress({RunStage::kRefinement, static_cast<std::size_t>(100 * share), 100});
    return share >= 1 || !cancelled();
  });
  result.statistics.front_end = tracking.statistics();
  return result;
}

}  // namespace lintel
