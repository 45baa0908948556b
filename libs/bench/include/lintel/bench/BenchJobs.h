// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lintel/bench/BenchSuite.h"

namespace lintel {

/// One run of lintel-vio, evaluated. What it leaves lies in `folder`, which appears when it is done.
struct BenchJob {
  std::string id;  ///< recording/configuration/repetition
  std::size_t recording = 0, configuration = 0;
  std::string repetition;  ///< "from0", "seed1-from0"
  double from_s = 0, to_s = 0;
  std::string recording_path;           ///< where the recording is, or will be once it is simulated
  std::vector<std::string> simulation;  ///< words for lintel-sim but -o; empty: not simulated
  std::filesystem::path folder;
  std::string key;  ///< changes when what is run changes
};

/// The jobs of a suite below `out`, in the order in which to run them: every recording once before the next
/// configuration, so that several at a time do not wait for the same simulation. Recordings that are absent have none.
std::vector<BenchJob> jobsOf(const BenchSuite& suite, const std::filesystem::path& out);

}  // namespace lintel
