// SPDX-License-Identifier: BSD-3-Clause
#include "ArrivalTimes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

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

Intervals intervalsOf(const std::deque<ImuSample>& samples) {
  Intervals all;
  const std::size_t n = samples.size() - 1;
  all.mean_ns = static_cast<double>(samples.back().t_ns - samples.front().t_ns) / static_cast<double>(n);
  const auto deviation = [&](std::size_t i) {
    return static_cast<double>(samples[i + 1].t_ns - samples[i].t_ns) - all.mean_ns;
  };
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

ArrivalTimes::ArrivalTimes(const std::deque<ImuSample>& first) : last_ns_(std::numeric_limits<std::int64_t>::min()) {
  if (first.size() < kLeastSamples) return;
  const Intervals intervals = intervalsOf(first);
  mean_ns_ = intervals.mean_ns;
  char text[200] = "";
  if (intervals.short_share > kShortShare) {
    drop_out_ns_ = kDropOut * intervals.long_ns;
    std::snprintf(text, sizeof text, "IMU samples come in packets of about %.0f that were stamped on arrival",
                  intervals.samples_each);
  } else if (intervals.scatter_ns > kScatter * mean_ns_ && intervals.correlation < kCorrelation) {
    drop_out_ns_ = kDropOut * mean_ns_;
    std::snprintf(text, sizeof text, "the stamps of IMU samples scatter by %.1f ms about even ones",
                  1e-6 * intervals.scatter_ns / std::sqrt(2.0));
  }
  remark_ = text;
}

/// Whether there is a drop-out before sample i.
bool ArrivalTimes::startsAnew(std::size_t i) const {
  return static_cast<double>(samples_[i].t_ns - samples_[i - 1].t_ns) > drop_out_ns_;
}

/// A line by least squares; stamps count less the farther they are, so that where the window cuts a packet does not
/// matter.
std::int64_t ArrivalTimes::timeOf(std::size_t i) const {
  const std::int64_t stamp_ns = samples_[i].t_ns;
  double w_sum = 0, k_sum = 0, t_sum = 0, kk_sum = 0, kt_sum = 0;
  const auto add = [&](std::size_t j) {
    const double k = static_cast<double>(j) - static_cast<double>(i);
    const auto t_ns = static_cast<double>(samples_[j].t_ns - stamp_ns);
    const double w = 1 - std::abs(k) * mean_ns_ / (kReach_ns + mean_ns_);
    if (w <= 0) return false;
    w_sum += w, k_sum += w * k, t_sum += w * t_ns, kk_sum += w * k * k, kt_sum += w * k * t_ns;
    return true;
  };
  add(i);
  for (std::size_t j = i; j > 0 && !startsAnew(j) && add(j - 1); --j) {
  }
  for (std::size_t j = i + 1; j < samples_.size() && !startsAnew(j) && add(j); ++j) {
  }
  const double determinant = w_sum * kk_sum - k_sum * k_sum;
  const double slope_ns = determinant > 0 ? (w_sum * kt_sum - k_sum * t_sum) / determinant : 0;
  return stamp_ns + std::llround((t_sum - slope_ns * k_sum) / w_sum);
}

void ArrivalTimes::push(const ImuSample& sample) { samples_.push_back(sample); }

std::optional<ImuSample> ArrivalTimes::pop(bool at_end) {
  const auto reach = static_cast<std::size_t>(kReach_ns / mean_ns_) + 1;
  if (next_ == samples_.size() || (!at_end && next_ + reach >= samples_.size())) return std::nullopt;
  ImuSample sample = samples_[next_];
  sample.t_ns = last_ns_ = std::max(timeOf(next_), last_ns_ + 1);
  ++next_;
  while (next_ > reach + 1) samples_.pop_front(), --next_;
  return sample;
}

}  // namespace lintel
