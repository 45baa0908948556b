// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "lintel/core/Frame.h"

namespace lintel {

/// Values at the end of a sensor's range: what was to be measured is larger. An end shows in that its value, the
/// largest or smallest so far, comes again and again, and those next to it do not. Such values are replaced by a cubic
/// through the samples before and after, and how much they may be wrong is said (ImuSample::gyro_open, accel_open).
class RangeEnds {
 public:
  /// Ascending in time.
  void push(const ImuSample& sample);

  /// The next sample, once those around it are known or `at_end`; `remark` becomes what is to be said of an end
  /// that was found with it, or empty.
  std::optional<ImuSample> pop(bool at_end, std::string& remark);

 private:
  /// One of both ends of an axis. Values are those of the axis times `sign`.
  struct End {
    int axis = 0, sign = 1;
    double value = -std::numeric_limits<double>::infinity();  ///< the largest so far
    int count = 0, runs = 0, row = 0;                         ///< samples that have it; runs of them; the last in a row
    int below = 0;                                            ///< samples little smaller than it
    bool known = false, said = false;
  };

  /// Samples in a row at an end.
  struct Run {
    std::size_t first, last;
  };

  void count(const ImuSample& sample, End& end) const;
  static bool canEnd(const End& end);
  bool isAt(const End& end, std::size_t i) const;
  std::optional<Run> runAt(const End& end, std::size_t i) const;
  bool goesOn(std::size_t i) const;
  bool isComplete(const Run& run) const;
  bool isSurrounded(const Run& run) const;
  double slope(const End& end, std::size_t from, std::size_t to) const;
  void extend(const End& end, const Run& run, ImuSample& sample) const;

  std::array<End, 12> ends_ = everyEnd();
  std::array<double, 6> step_ = everyStep();  ///< smallest difference of two samples: what the sensor resolves
  std::deque<ImuSample> samples_;             ///< as they came; the next one is at `next_`
  std::size_t next_ = 0;

  static std::array<End, 12> everyEnd();
  static std::array<double, 6> everyStep();
};

}  // namespace lintel
