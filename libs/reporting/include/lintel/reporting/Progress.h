// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>

namespace lintel {

/// How progress is shown.
enum class ProgressStyle {
  None,   ///< not at all (--quiet)
  Lines,  ///< a line every few seconds, for logs
  Bar     ///< one line redrawn, for terminals
};

/// None when quiet, Bar when `out` is std::cerr or std::cout and that is a terminal, else Lines.
ProgressStyle progressStyleFor(const std::ostream& out, bool quiet);

/// Shows how far a long work has come, its rate and the time left.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;
  using Now = std::function<Clock::time_point()>;

  /// `what`: the work, e.g. "writing"; `unit`: what is counted, e.g. "frames"; `total` 0 = not known. `out` must
  /// outlive this. `now` is for tests.
  Progress(std::ostream& out, ProgressStyle style, std::string what, std::string unit, std::size_t total,
           Now now = Clock::now);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Cheap: draws ten times a second (Bar) or every five seconds (Lines). `total` may become known or change.
  void update(std::size_t done) { update(done, total_); }
  void update(std::size_t done, std::size_t total);

  /// Removes the bar so that other output can follow; a later update draws it again. Called by the destructor.
  void clear();

 private:
  std::string text(double elapsed_s) const;
  std::string bar() const;

  std::ostream& out_;
  ProgressStyle style_;
  std::string what_, unit_;
  std::size_t done_ = 0, total_;
  Now now_;
  Clock::time_point start_, last_drawn_;
  std::size_t drawn_width_ = 0;
};

/// A duration for people: "8 s", "3 min 20 s", "2 h 05 min".
std::string durationText(double seconds);

}  // namespace lintel
