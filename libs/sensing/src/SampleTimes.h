// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace lintel {

/// Times of IMU samples that a computer has stamped when they arrived. A serial line or a driver may hand them over in
/// packets, and all of a packet bear nearly the same time; or each is late by an amount of its own. The sensor takes
/// them evenly: each gets the time that a straight line through the stamps of a second before and after has at its
/// number. What all are late by stays: it is part of the offset between the clocks.
class SampleTimes {
 public:
  static constexpr std::int64_t kLook_ns = 2'000'000'000;   ///< of samples, to see how they come
  static constexpr std::int64_t kAhead_ns = 1'500'000'000;  ///< what pop() needs after one, and a packet

  /// Looks at the first samples' stamps [ns], ascending.
  explicit SampleTimes(const std::vector<std::int64_t>& first);

  /// Whether `seen` are enough for the constructor.
  static bool suffice(const std::vector<std::int64_t>& seen) {
    return !seen.empty() && seen.back() - seen.front() >= kLook_ns;
  }

  /// Whether the stamps are those of arrival. In packets intervals much shorter than the mean are frequent. Stamps that
  /// scatter by themselves about even times make a long interval follow a short one: the correlation of neighbours is
  /// -1/2. A sensor's own stamps have neither, however uneven: samples that are missing or taken later leave the next
  /// interval as it is.
  bool found() const { return !remark_.empty(); }
  const std::string& remark() const { return remark_; }  ///< what they are, in words
  double rate_hz() const { return 1e9 / mean_ns_; }

  /// Ascending.
  void push(std::int64_t t_ns) { stamps_.push_back(t_ns); }

  /// The next sample with its own time, once the stamps of the second after it are known or `at_end`.
  std::optional<std::int64_t> pop(bool at_end);

 private:
  bool startsAnew(std::size_t i) const;
  std::int64_t timeOf(std::size_t i) const;

  std::string remark_;
  double mean_ns_ = 1, drop_out_ns_ = 1;
  std::deque<std::int64_t> stamps_;  ///< the next one is at `next_`, before it those of a second
  std::size_t next_ = 0;
};

}  // namespace lintel
