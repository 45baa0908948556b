// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ReadAhead.h"
#include "TimeTicks.h"
#include "lintel/core/Formatted.h"

namespace lintel {

/// What one sensor delivers, with even times where `Times` (SampleTimes, FrameTimes) finds that it was stamped on
/// arrival; else as it is. An Item has a time `t_ns`.
template <typename Item, typename Times>
class EvenTimes {
 public:
  using Read = typename ReadAhead<Item>::Read;
  using Say = std::function<void(std::string)>;

  /// The next item; empty when `read` gives none, which is asked for items up to `ahead_ns` after it. `say` is told
  /// what is found. A fault (RecordingError) is thrown when all that were read before it are delivered.
  std::optional<Item> next(const Read& read, const Say& say) {
    if (!times_) lookAtFirst(read, say);
    return times_ && times_->found() ? nextEven(read) : nextAsItIs(read);
  }

 private:
  void lookAtFirst(const Read& read, const Say& say) {
    std::vector<std::int64_t> stamps;
    while (!Times::suffice(stamps)) {
      std::optional<Item> item = ahead_.next(read, Times::kLook_ns);
      if (!item) break;
      stamps.push_back(item->t_ns);
      waiting_.push_back(std::move(*item));
    }
    if (stamps.empty()) return;  // they may begin later
    times_.emplace(stamps);
    if (!times_->found()) return;
    say(times_->remark() + formatted(": their times are taken as even, %.0f a second", times_->rate_hz()));
    for (const std::int64_t t_ns : stamps) times_->push(t_ns);
  }

  std::optional<Item> nextAsItIs(const Read& read) {
    if (!waiting_.empty()) return take();
    ahead_.endOrFault();
    return read(0);
  }

  std::optional<Item> nextEven(const Read& read) {
    std::optional<std::int64_t> t_ns;
    while (!(t_ns = times_->pop(false))) {
      std::optional<Item> item = ahead_.next(read, Times::kAhead_ns);
      if (!item) break;
      times_->push(item->t_ns);
      waiting_.push_back(std::move(*item));
    }
    if (!t_ns) t_ns = times_->pop(true);
    if (!t_ns) {
      ahead_.endOrFault();
      return std::nullopt;
    }
    std::optional<Item> item = take();
    item->t_ns = last_ns_ = std::max(cutToTick(*t_ns), last_ns_ + kTick_ns);
    return item;
  }

  std::optional<Item> take() {
    std::optional<Item> item = std::move(waiting_.front());
    waiting_.pop_front();
    return item;
  }

  ReadAhead<Item> ahead_;
  std::optional<Times> times_;
  std::deque<Item> waiting_;  ///< read and not delivered
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min() / 2;
};

}  // namespace lintel
