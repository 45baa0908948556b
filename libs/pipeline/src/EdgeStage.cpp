// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeStage.h"

namespace lintel {

namespace {

constexpr std::size_t kMostWaiting = 40;  // frames before a start: 2 s of 20 Hz

}  // namespace

void EdgeStage::search(const Frame& frame, StageClock& clock) {
  if (!edges_.empty() && frame.t_ns - edges_.rbegin()->first < interval_ns_) return;
  const StageClock::Scope scope(clock);
  std::vector<EdgeSegment>& found = edges_[frame.t_ns] = detector_.detect(*frame.image);
  found.shrink_to_fit();
}

void EdgeStage::add(const Frame& frame, const WindowUpdate& update, StageClock& clock) {
  if (update.status == EstimatorStatus::kPropagated) return;
  if (update.status == EstimatorStatus::kTracking) {
    // the frames of a start all stay in the window; afterwards one waits at a time
    if (update.keyframe || waiting_.size() > 1)
      for (const Frame& waiting : waiting_) search(waiting, clock);
    waiting_.clear();
  }
  waiting_.push_back(frame);
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
}

}  // namespace lintel
