// SPDX-License-Identifier: BSD-3-Clause
// load_figures RECORDING [refine]: memory and CPU time of a long recording, a line of JSON for every minute of it
// (long_run).
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "../ToolMain.h"
#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/RunStatistics.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

struct Minute {
  double resident_mb = 0;
  std::size_t frames = 0;
};

double residentMb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

double medianMs(const OdometryStatistics& s, std::size_t from, std::size_t to) {
  std::vector<double> ms;
  for (std::size_t i = from; i < to; ++i) ms.push_back(s.decoding.ms()[i] + s.tracking.ms()[i] + s.estimation.ms()[i]);
  if (ms.empty()) return 0;
  std::nth_element(ms.begin(), ms.begin() + ms.size() / 2, ms.end());
  return ms[ms.size() / 2];
}

void run(const std::string& path, bool refine) {
  auto recording = openRecording(path, {});
  Configuration configuration;
  configuration.refinement.enabled = refine;
  std::vector<Minute> minutes;
  std::int64_t first_ns = 0;
  RunOptions options;
  options.observer = [&](const Frame& frame, const FrameTracks&, const WindowUpdate&, std::size_t done) {
    if (done == 1) first_ns = frame.t_ns;
    const auto minute = static_cast<std::size_t>((frame.t_ns - first_ns) / 60000000000);
    if (minute >= minutes.size()) minutes.resize(minute + 1);
    Minute& now = minutes[minute];
    now.frames = done;
    if (done % 20 != 0) return;
    now.resident_mb = std::max(now.resident_mb, residentMb());
  };
  const OdometryResult result = runOdometry(*recording, configuration, options);
  std::size_t from = 0;
  for (std::size_t i = 0; i < minutes.size(); ++i) {
    const Minute& m = minutes[i];
    std::printf("{\"minute\": %zu, \"frames\": %zu, \"resident_mb\": %.1f, \"median_ms\": %.3f}\n", i + 1,
                m.frames - from, m.resident_mb, medianMs(result.statistics, from, m.frames));
    from = m.frames;
  }
  std::printf(
      "{\"poses\": %zu, \"keyframes\": %zu, \"resets\": %zu, \"points\": %zu, \"lines\": %zu, \"peak_mb\": %.1f, "
      "\"refinement_s\": %.1f, \"loops_s\": %.1f, \"error\": \"%s\"}\n",
      result.trajectory.size(), result.statistics.keyframes, result.statistics.resets, result.map.points.size(),
      result.map.lines.size(), peakMemoryMb(), 1e-3 * result.statistics.refinement.sumMs(),
      1e-3 * result.statistics.loops.sumMs(), result.error.c_str());
}

int runTool(int argc, char** argv) {
  if (argc < 2) throw std::runtime_error("usage: load_figures RECORDING [refine]");
  run(argv[1], argc > 2 && std::string(argv[2]) == "refine");
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("load_figures", lintel::runTool, argc, argv); }
