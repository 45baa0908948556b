// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchJobs.h"

#include "lintel/core/ChildProcess.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/TextFile.h"
#include "lintel/core/Version.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

std::string sixDigits(double value) { return formatted("%g", value); }

/// FNV-1a: short, and the same everywhere.
std::string hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return formatted("%016llx", static_cast<unsigned long long>(hash));
}

/// What decides the result, but not where files happen to lie: a run made on another machine is the same run.
std::string keyOf(const BenchJob& job, const BenchRecording& recording, const BenchConfiguration& configuration) {
  const std::vector<std::string> words{version(),
                                       job.id,
                                       sixDigits(job.from_s),
                                       sixDigits(job.to_s),
                                       shellLine(job.simulation),
                                       bytesOfFile(configuration.config),
                                       shellLine(configuration.settings),
                                       bytesOfFile(recording.groundtruth)};
  return hashOf(shellLine(words));
}

}  // namespace

std::vector<BenchJob> jobsOf(const BenchSuite& suite, const fs::path& out) {
  std::vector<BenchJob> jobs;
  const auto add = [&](std::size_t r, std::size_t c, double start_s, const std::uint64_t* seed) {
    const BenchRecording& recording = suite.recordings[r];
    BenchJob job;
    job.recording = r;
    job.configuration = c;
    job.repetition = (seed ? "seed" + std::to_string(*seed) + "-" : "") + "from" + sixDigits(start_s);
    job.id = recording.name + "/" + suite.configurations[c].name + "/" + job.repetition;
    job.from_s = recording.from_s + start_s;
    job.to_s = recording.to_s;
    job.recording_path = recording.path;
    if (seed) {
      job.recording_path = (out / "recordings" / (recording.name + "-seed" + std::to_string(*seed))).string();
      job.simulation = recording.simulation;
      job.simulation.insert(job.simulation.end(), {"--seed", std::to_string(*seed)});
    }
    job.folder = out / "runs" / job.id;
    job.key = keyOf(job, recording, suite.configurations[c]);
    jobs.push_back(job);
  };
  for (const double start_s : suite.starts_s)
    for (std::size_t c = 0; c < suite.configurations.size(); ++c)
      for (std::size_t r = 0; r < suite.recordings.size(); ++r) {
        const BenchRecording& recording = suite.recordings[r];
        if (recording.absent()) continue;
        if (!recording.simulated())
          add(r, c, start_s, nullptr);
        else
          for (const std::uint64_t& seed : recording.seeds) add(r, c, start_s, &seed);
      }
  return jobs;
}

}  // namespace lintel
