// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace lintel {

/// Times of a camera's images that a computer has stamped when they arrived, each late by an amount of its own. The
/// camera takes them at multiples of a period, though some may be lost: each gets the time that a straight line through
/// the stamps of the frames before and after has at its number. What all are late by stays: it is part of the offset
/// between the clocks.
class FrameTimes {
 public:
  static constexpr std::int64_t kLook_ns = 0, kAhead_ns = 0;  ///< frames are counted

  /// Looks at the first frames' stamps [ns], ascending.
  explicit FrameTimes(const std::vector<std::int64_t>& first);

  /// Whether `seen` are enough for the constructor.
  static bool suffice(const std::vector<std::int64_t>& seen) { return seen.size() >= 40; }

  /// Whether the stamps scatter by themselves about multiples of a period. They are left where they keep to them, and
  /// where the camera's intervals are uneven themselves: then the distance from even times grows with their number.
  bool found() const { return !remark_.empty(); }
  const std::string& remark() const { return remark_; }  ///< what they are, in words
  double rate_hz() const { return 1e9 / period_ns_; }

  /// Ascending.
  void push(std::int64_t t_ns);

  /// The next frame's own time, once the stamps of kReach frames after it are known or `at_end`.
  std::optional<std::int64_t> pop(bool at_end);

 private:
  static constexpr std::size_t kReach = 20;  // frames to both sides: a second at 20 Hz

  struct Stamp {
    std::int64_t t_ns;
    double number;  ///< of its period
  };
  bool moveBack();
  std::int64_t timeOf(const Stamp& stamp) const;

  std::string remark_;
  double period_ns_ = 1, scatter_ns_ = 0;
  double number_ = 0, expected_ns_ = 0;  ///< the last frame's, and its stamp by those before
  std::deque<Stamp> stamps_;             ///< the next one is at `next_`, before it those that its line needs
  std::size_t next_ = 0;
};

}  // namespace lintel
