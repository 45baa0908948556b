// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchResults.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "BenchJson.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

using Json = nlohmann::ordered_json;

Json readJson(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return {};
  Json json = Json::parse(file, nullptr, false);
  return json.is_discarded() ? Json() : json;
}

namespace {

BenchRun readRun(const BenchJob& job) {
  BenchRun run;
  const Json json = readJson(job.folder / "job.json");
  run.found = json.is_object();
  if (!run.found) return run;
  run.fault = json.value("fault", "");
  run.evaluation = readJson(job.folder / "evaluation.json");
  run.evaluation_refined = readJson(job.folder / "evaluation_refined.json");
  run.stats = readJson(job.folder / "stats.json");
  return run;
}

}  // namespace

double BenchRun::number(const Json& json, const std::string& path) {
  const Json::json_pointer pointer(path);
  if (!json.is_structured() || !json.contains(pointer) || !json.at(pointer).is_number())
    return std::numeric_limits<double>::quiet_NaN();
  return json.at(pointer).get<double>();
}

std::size_t BenchCell::missing() const {
  return static_cast<std::size_t>(std::count_if(runs_.begin(), runs_.end(), [](const auto& r) { return !r.found; }));
}

std::size_t BenchCell::failed() const {
  return static_cast<std::size_t>(
      std::count_if(runs_.begin(), runs_.end(), [](const auto& r) { return r.found && !r.fault.empty(); }));
}

std::string BenchCell::firstFault() const {
  for (const BenchRun& run : runs_)
    if (!run.fault.empty()) return run.fault;
  return "";
}

bool BenchCell::anyOk() const {
  return std::any_of(runs_.begin(), runs_.end(), [](const auto& r) { return r.ok(); });
}

bool BenchCell::complete() const {
  return std::all_of(runs_.begin(), runs_.end(), [](const auto& r) {
    const Json::json_pointer path("/trajectory/complete");
    return r.ok() && (!r.evaluation.contains(path) || r.evaluation.at(path) == true);
  });
}

double BenchCell::median(Json BenchRun::*part, const std::string& path) const {
  std::vector<double> values;
  for (const BenchRun& run : runs_)
    if (const double value = BenchRun::number(run.*part, path); run.ok() && std::isfinite(value))
      values.push_back(value);
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return lintel::median(values);
}

BenchResults::BenchResults(const BenchSuite& suite, const std::vector<BenchJob>& jobs)
    : configurations_(suite.configurations.size()), cells_(suite.recordings.size() * configurations_) {
  for (const BenchJob& job : jobs) {
    BenchRun run = readRun(job);
    cells_[job.recording * configurations_ + job.configuration].add(run);
    runs_.emplace_back(job, std::move(run));
  }
}

std::size_t BenchResults::missing() const {
  return static_cast<std::size_t>(
      std::count_if(runs_.begin(), runs_.end(), [](const auto& r) { return !r.second.found; }));
}

}  // namespace lintel
