// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/Progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "lintel/core/Formatted.h"

namespace lintel {
namespace {

constexpr std::chrono::milliseconds kBarPeriod{100}, kLinePeriod{5000};
constexpr std::size_t kBarWidth = 24;

}  // namespace

std::string durationText(double seconds) {
  const long long s = std::llround(std::clamp(seconds, 0.0, 1e9));
  if (s < 60) return formatted("%lld s", s);
  if (s < 3600) return formatted("%lld min %02lld s", s / 60, s % 60);
  return formatted("%lld h %02lld min", s / 3600, s / 60 % 60);
}

ProgressStyle progressStyleFor(const std::ostream& out, bool quiet) {
  if (quiet) return ProgressStyle::None;
  const bool terminal =
      (&out == &std::cerr && isatty(STDERR_FILENO) != 0) || (&out == &std::cout && isatty(STDOUT_FILENO) != 0);
  return terminal ? ProgressStyle::Bar : ProgressStyle::Lines;
}

Progress::Progress(std::ostream& out, ProgressStyle style, std::string what, std::string unit, std::size_t total,
                   Now now)
    : out_(out),
      style_(style),
      what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      now_(std::move(now)),
      start_(now_()),
      last_drawn_(start_) {}

Progress::~Progress() { clear(); }

std::string Progress::bar() const {
  const std::size_t filled = std::min(kBarWidth, kBarWidth * done_ / total_);
  return "[" + std::string(filled, '#') + std::string(kBarWidth - filled, '-') + "] ";
}

std::string Progress::text(double elapsed_s) const {
  std::string line = std::to_string(done_);
  if (total_ > 0) line += "/" + std::to_string(total_);
  line += " " + unit_;
  if (elapsed_s <= 0 || done_ == 0) return line;
  const double rate = static_cast<double>(done_) / elapsed_s;
  line += formatted(rate < 10 ? ", %.1f/s" : ", %.0f/s", rate);
  if (total_ > done_) line += ", " + durationText(static_cast<double>(total_ - done_) / rate) + " left";
  return line;
}

void Progress::update(std::size_t done, std::size_t total) {
  done_ = done;
  total_ = total;
  if (style_ == ProgressStyle::None) return;
  const Clock::time_point now = now_();
  if (now - last_drawn_ < (style_ == ProgressStyle::Bar ? kBarPeriod : kLinePeriod)) return;
  last_drawn_ = now;
  const std::string line = text(std::chrono::duration<double>(now - start_).count());
  if (style_ == ProgressStyle::Lines) {
    out_ << what_ << ": " << line << std::endl;
    return;
  }
  std::string drawn = what_ + " " + (total_ > 0 ? bar() : "") + line;
  const std::size_t width = drawn.size();
  if (width < drawn_width_) drawn.append(drawn_width_ - width, ' ');  // covers the longer line before
  drawn_width_ = width;
  out_ << '\r' << drawn << std::flush;
}

void Progress::clear() {
  if (drawn_width_ == 0) return;
  out_ << '\r' << std::string(drawn_width_, ' ') << '\r' << std::flush;
  drawn_width_ = 0;
}

}  // namespace lintel
