// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace lintel {

/// What an output folder says of the run that wrote it (`lintel-vio --resume`).
struct EarlierRun {
  enum class State { kNone, kBroken, kWhole };

  State state = State::kNone;
  std::string reason;   ///< of kBroken: why it ended early
  std::string verdict;  ///< of kWhole: why its result is not to be trusted; empty if nothing speaks against it
  std::vector<std::string> command;
  std::string configuration;  ///< config.yaml

  /// Reads stats.json and config.yaml of `folder`. A run whose stats.json, written last, is missing or no JSON is
  /// broken.
  static EarlierRun in(const std::string& folder);
};

/// The arguments that decide what a run computes and writes: without --resume, -w and -q.
std::vector<std::string> essentialArguments(int argc, const char* const* argv);

}  // namespace lintel
