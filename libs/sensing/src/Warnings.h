// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lintel {

/// Small faults that are skipped and noted.
enum class Fault {
  Image,
  ImageRepeat,
  ImageStamp,
  ImuStamp,
  ImuValue,
  ImuSpike,
  ImuRange,
  CutLine,
  ImuGap,
  ImuBridged,
  Calibration,
  Other
};

struct Warning {
  Fault fault = Fault::Other;
  std::string text;  ///< one line: what, where
};

/// Where readers put the faults they skip.
using WarningSink = std::function<void(Fault, std::string)>;

/// Collects warnings: the first few of a kind in full, of the rest the count, so that it never grows.
class WarningLog {
 public:
  explicit WarningLog(const std::vector<Warning>& warnings = {}) {
    for (const Warning& warning : warnings) add(warning);
  }
  void add(const Warning& warning);
  std::vector<std::string> lines() const;

 private:
  struct Kind {
    std::vector<std::string> texts;
    std::size_t count = 0;
  };
  std::map<Fault, Kind> kinds_;
};

}  // namespace lintel
