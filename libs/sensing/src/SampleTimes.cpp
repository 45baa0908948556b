// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTimes.h"

#include <algorithm>
#include <cmath>

#include "StampLine.h"
#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr std::size_t kLeastSamples = 50;  // to say how they come
constexpr double kShort = 0.3;             // of the mean interval
constexpr double kShortShare = 0.4;        // of the intervals: in packets of two it is a half
constexpr double kScatter = 0.1;           // of the mean interval: less does no harm
constexpr double kCorrelation = -0.4;      // of neighbouring intervals
constexpr double kReach_ns = 1e9;          // to both sides
constexpr double kDropOut = 2.5;           // usual intervals, between packets, after which numbers say nothing

/// How the intervals between samples are.
struct Intervals {
  double mean_ns = 0;
  double short_share = 0;   ///< of those much shorter than the mean
  double long_ns = 0;       ///< mean of those longer than the mean
  double samples_each = 0;  ///< samples for each of these
  double scatter_ns = 0;    ///< standard deviation, without drop-outs
  double correlation = 0;   ///< of neighbours, without drop-outs
};

Intervals intervalsOf(const std::vector<std::int64_t>& stamps) {
  Intervals all;
  const std::size_t n = stamps.size() - 1;
  all.mean_ns = static_cast<double>(stamps.back() - stamps.front()) / static_cast<double>(n);
  const auto deviation = [&](std::size_t i) { return static_cast<double>(stamps[i + 1] - stamps[i]) - all.mean_ns; };
  const auto isDropOut = [&](std::size_t i) { return deviation(i) > (kDropOut - 1) * all.mean_ns; };
  double brief = 0, longer = 0, squares = 0, products = 0, single = 0, pairs = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double d = deviation(i);
    brief += d < (kShort - 1) * all.mean_ns;
    if (d > 0) all.long_ns += all.mean_ns + d, ++longer;
    if (isDropOut(i)) continue;
    squares += d * d, ++single;
    if (i + 1 < n && !isDropOut(i + 1)) products += d * deviation(i + 1), ++pairs;
  }
  all.short_share = brief / static_cast<double>(n);
  all.long_ns /= std::max(1.0, longer);
  all.samples_each = static_cast<double>(n) / std::max(1.0, longer);
  all.scatter_ns = std::sqrt(squares / std::max(1.0, single));
  all.correlation = squares > 0 ? products / std::max(1.0, pairs) / (squares / single) : 0;
  return all;
}

}  // namespace

SampleTimes::SampleTimes(const std::vector<std::int64_t>& first) {
  if (first.size() < kLeastSamples) return;
  const Intervals intervals = intervalsOf(first);
  if (intervals.mean_ns <= 0) return;  // all stamped together
  mean_ns_ = intervals.mean_ns;
  if (intervals.short_share > kShortShare) {
    drop_out_ns_ = kDropOut * intervals.long_ns;
    remark_ =
        formatted("IMU samples come in packets of about %.0f that were stamped on arrival", intervals.samples_each);
  } else if (intervals.scatter_ns > kScatter * mean_ns_ && intervals.correlation < kCorrelation) {
    drop_out_ns_ = kDropOut * mean_ns_;
    remark_ = formatted("the stamps of IMU samples scatter by %.1f ms about even ones",
                        1e-6 * intervals.scatter_ns / std::sqrt(2.0));
  }
}

/// Whether there is a drop-out before sample i.
bool SampleTimes::startsAnew(std::size_t i) const {
  return static_cast<double>(stamps_[i] - stamps_[i - 1]) > drop_out_ns_;
}

/// A line by least squares; stamps count less the farther they are, so that where the window cuts a packet does not
/// matter.
std::int64_t SampleTimes::timeOf(std::size_t i) const {
  StampLine line;
  const auto add = [&](std::size_t j) {
    const double k = static_cast<double>(j) - static_cast<double>(i);
    const double weight = 1 - std::abs(k) * mean_ns_ / (kReach_ns + mean_ns_);
    if (weight <= 0) return false;
    line.add(weight, k, static_cast<double>(stamps_[j] - stamps_[i]));
    return true;
  };
  add(i);
  for (std::size_t j = i; j > 0 && !startsAnew(j) && add(j - 1); --j) {
  }
  for (std::size_t j = i + 1; j < stamps_.size() && !startsAnew(j) && add(j); ++j) {
  }
  return stamps_[i] + std::llround(line.at(0));
}

std::optional<std::int64_t> SampleTimes::pop(bool at_end) {
  const auto reach = static_cast<std::size_t>(kReach_ns / mean_ns_) + 1;
  if (next_ == stamps_.size() || (!at_end && next_ + reach >= stamps_.size())) return std::nullopt;
  const std::int64_t t_ns = timeOf(next_++);
  while (next_ > reach + 1) stamps_.pop_front(), --next_;
  return t_ns;
}

}  // namespace lintel
