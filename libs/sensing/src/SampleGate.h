// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "Warnings.h"
#include "lintel/core/Frame.h"

namespace lintel {

/// Lets only strictly increasing times pass (a duplicated or reordered sample is dropped with a warning).
class StampGate {
 public:
  /// `what`: "image" or "IMU sample"; `fault`: the kind its faults are counted as.
  StampGate(std::string what, Fault fault) : what_(std::move(what)), fault_(fault) {}

  /// `where` is called only when there is something to report.
  bool admit(std::int64_t t_ns, const std::function<std::string()>& where, const WarningSink& warn);

 private:
  std::string what_;
  Fault fault_;
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
};

/// StampGate that also drops samples with NaN or infinity, and lets pass one with the time of the one before but other
/// values: it was measured later, and they were stamped together when they arrived.
class ImuGate {
 public:
  bool admit(const ImuSample& sample, const std::function<std::string()>& where, const WarningSink& warn);

 private:
  StampGate stamps_{"IMU sample", Fault::ImuStamp};
  std::optional<ImuSample> last_;
};

}  // namespace lintel
