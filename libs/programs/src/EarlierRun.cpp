// SPDX-License-Identifier: BSD-3-Clause
#include "EarlierRun.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "RunFolder.h"
#include "lintel/core/TextFile.h"

namespace lintel {

namespace fs = std::filesystem;

EarlierRun EarlierRun::in(const std::string& folder) {
  EarlierRun run;
  const bool killed = fs::exists(TrajectoryCheckpoint::fileIn(folder));
  if (!killed && !fs::exists(fs::path(folder) / "trajectory.tum")) return run;
  run.state = State::kBroken;
  run.reason = "it was killed";
  run.configuration = bytesOfFile(fs::path(folder) / "config.yaml");
  const auto statistics = nlohmann::json::parse(bytesOfFile(fs::path(folder) / "stats.json"), nullptr, false);
  if (killed || !statistics.is_object()) return run;
  try {
    run.command = statistics.at("command").get<std::vector<std::string>>();
    run.reason = statistics.at("ended_early").get<std::string>();
    run.verdict = statistics.at("not_to_be_trusted").get<std::string>();
    if (run.verdict.empty() && statistics.at("frames_with_pose") == 0) run.verdict = "no pose was found";
    if (!statistics.at("partial").get<bool>()) run.state = State::kWhole;
  } catch (const nlohmann::json::exception&) {
    run.reason = "its stats.json is of another version";
  }
  return run;
}

std::vector<std::string> essentialArguments(int argc, const char* const* argv) {
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  const std::vector<std::string> others{"--resume", "-w", "--overwrite", "-q", "--quiet"};
  const auto other = [&](const std::string& argument) {
    return std::find(others.begin(), others.end(), argument) != others.end();
  };
  arguments.erase(std::remove_if(arguments.begin(), arguments.end(), other), arguments.end());
  return arguments;
}

}  // namespace lintel
