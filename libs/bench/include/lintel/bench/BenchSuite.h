// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lintel {

/// A suite that cannot be read: one line naming file, line and remedy.
class SuiteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A recording of a suite.
struct BenchRecording {
  std::string name;
  std::string path;                     ///< EuRoC folder or rawlog; empty: not found, or simulated
  std::vector<std::string> simulation;  ///< words for lintel-sim but -o and --seed; empty: not simulated
  std::vector<std::uint64_t> seeds;     ///< of the simulation
  std::string groundtruth;              ///< a file; empty: what the recording carries
  double from_s = 0, to_s = 0;          ///< as lintel-vio's --from and --to
  bool simulated() const { return !simulation.empty(); }
  bool absent() const { return path.empty() && !simulated(); }
};

struct BenchConfiguration {
  std::string name;
  std::string config;                 ///< file for lintel-vio's -c; empty: none
  std::vector<std::string> settings;  ///< for lintel-vio's --set
};

/// RMSE and, where it was given, maximum [m] as published.
struct PublishedErrors {
  double rmse_m = 0;
  std::optional<double> max_m;
};

struct PublishedSystem {
  std::string name, source;                       ///< where the figures were published; empty: the suite does not say
  std::map<std::string, PublishedErrors> errors;  ///< by recording
};

/// What lintel-bench runs.
struct BenchSuite {
  std::string name, title;
  std::vector<BenchRecording> recordings;
  std::vector<BenchConfiguration> configurations;
  std::vector<double> starts_s{0};  ///< every run is repeated from these times after the recording's start
  std::vector<PublishedSystem> published;
  std::vector<std::string> notes;  ///< put below the tables
};

/// Reads a suite. Recordings by name are looked for in `folder`: NAME or */NAME as EuRoC folders, NAME.rawlog; one that
/// is not there stays in the suite with an empty path. Throws SuiteError.
BenchSuite readSuite(const std::string& file, const std::string& folder);

}  // namespace lintel
