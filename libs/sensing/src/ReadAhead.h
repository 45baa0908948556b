// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <functional>
#include <optional>

#include "lintel/sensing/Recording.h"

namespace lintel {

/// Reads items ahead of those that are delivered: a fault met there (RecordingError) must not take these.
template <typename Item>
class ReadAhead {
 public:
  /// The next item, of times up to `ahead_ns` after what is asked for; empty when there is none.
  using Read = std::function<std::optional<Item>(std::int64_t ahead_ns)>;

  /// Empty after a fault as well.
  std::optional<Item> next(const Read& read, std::int64_t ahead_ns) {
    if (fault_) return std::nullopt;
    try {
      return read(ahead_ns);
    } catch (const RecordingError&) {
      fault_ = std::current_exception();
      return std::nullopt;
    }
  }

  /// Throws the fault, if one was met: when all that was read before it is delivered.
  void endOrFault() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  std::exception_ptr fault_;
};

}  // namespace lintel
